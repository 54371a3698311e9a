// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/ensemble/ensemble_file.hpp"

#include "common/stage/checksum.hpp"
#include "common/stage/stage.hpp"

namespace talus {
void write_ensemble_file(const std::filesystem::path& path, const EnsembleFileKind& kind,
                         const std::function<void(h5::File&)>& write) {
  PendingFile pending(path);
  h5::File file = h5::File::create(pending.path(), {pending.final_path(), ""});
  h5::set_format(file, kind.format);
  write(file);
  file.close();
  seal_file(pending.path(), pending.final_path());
  pending.commit();
}

h5::File open_ensemble_file(const std::filesystem::path& path, const EnsembleFileKind& kind) {
  return h5::open_sealed(path, {path, kind.mend}, kind.format);
}

}  // namespace talus
