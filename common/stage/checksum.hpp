// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Checksums of files, and the seal by which a file says that it is whole.
//
// A seal is the last line of a file of this program, in 128 bytes: the length of what stands before it and its SHA-256.
// OpenVDB and HDF5 read what they need from the front and by offsets, so other programs open a sealed file as ever.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <span>
#include <string>

struct evp_md_ctx_st;  // EVP_MD_CTX of libcrypto

namespace talus {

/// SHA-256 (FIPS 180-4) of bytes that come in parts.
class Sha256 {
 public:
  static constexpr std::size_t read_at_once = std::size_t{1} << 20;  ///< bytes of a file read in one block

  Sha256();
  Sha256(const Sha256& other);
  Sha256& operator=(const Sha256&) = delete;
  void add(std::span<const std::uint8_t> bytes);
  /// Digest of all bytes added, in hex. Call it once, after the last add().
  std::string digest();

 private:
  std::shared_ptr<evp_md_ctx_st> context_;  // of this object alone
};

/// Adds the seal to a file that is written and closed. Throws DataError (not writable), which calls it `shown`.
void seal_file(const std::filesystem::path& file, const std::filesystem::path& shown);

/// A sealed file, open at its begin. Notes its checksum for checksum_as_read(). Throws as require_seal().
std::ifstream open_sealed_stream(const std::filesystem::path& file, const std::string& mend);

/// SHA-256 in hex of a sealed file as this context has read it last, else of the file as it is; empty: no plain file.
std::string checksum_as_read(const std::filesystem::path& file);

/// Whether a file is sealed. The function throws DataError with `mend` where the seal is that of other bytes, or where
/// the file cannot be read. A file that is cut short has lost its seal and counts as one that never had any.
bool check_seal(const std::filesystem::path& file, const std::string& mend);

/// Throws DataError with `mend` where a file is not sealed, in addition to the faults of check_seal().
void require_seal(const std::filesystem::path& file, const std::string& mend);

}  // namespace talus
