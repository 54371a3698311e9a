// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The map over time as a film, encoded by ffmpeg.
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <sstream>

#include <fmt/format.h>

#include "common/stage/machine.hpp"
#include "common/stage/stage.hpp"
#include "postprocess/picture/map_picture.hpp"
#include "postprocess/score/thalweg.hpp"
#include "postprocess/writers/job.hpp"

namespace talus::postprocess {
namespace {

namespace fs = std::filesystem;

constexpr int seconds_at_the_end = 2;

/// Frames per second for a film of about eight seconds: 2 to 25.
int film_rate(std::size_t frames) {
  return std::clamp(static_cast<int>(std::lround(static_cast<double>(frames) / 8)), 2, 25);
}

bool has_program(const std::string& name) {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "" : path);
  for (std::string folder; std::getline(folders, folder, ':');)
    if (::access((fs::path(folder) / name).c_str(), X_OK) == 0) return true;
  return false;
}

/// For a shell: within single quotes everything but they themselves is plain.
std::string quoted(const std::string& text) {
  std::string safe = "'";
  for (const char c : text) safe += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return safe + "'";
}

/// A child's standard input. A child that ends early must not end us: SIGPIPE is ignored meanwhile.
class Pipe {
 public:
  explicit Pipe(const std::string& command)
      : before_(std::signal(SIGPIPE, SIG_IGN)), pipe_(::popen(command.c_str(), "w")) {}
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  ~Pipe() {
    close();
    std::signal(SIGPIPE, before_);
  }
  bool write(const std::string& bytes) {
    return pipe_ != nullptr && std::fwrite(bytes.data(), 1, bytes.size(), pipe_) == bytes.size();
  }
  /// True where the child ended well.
  bool close() {
    const int status = pipe_ == nullptr ? -1 : ::pclose(pipe_);
    pipe_ = nullptr;
    return status == 0;
  }

 private:
  void (*before_)(int);
  FILE* pipe_;
};

/// MP4 that every player takes (even sizes, 4:2:0); GIF smaller, with a palette of its own. Class colours are flat, so
/// nothing is dithered.
std::string encoding(std::string_view format) {
  if (format == "gif")
    return "-vf 'scale=960:-1:flags=lanczos,split[a][b];[a]palettegen[p];[b][p]paletteuse=dither=none' -f gif";
  return "-vf 'scale=1440:-2:flags=lanczos' -c:v libx264 -pix_fmt yuv420p -crf 20 -movflags +faststart -f mp4";
}

double thickest(const Run& run) {
  double most = 0;
  for (std::size_t i = 0; i < run.frames.time.size(); ++i) most = std::max(most, largest(flow_thickness(run, i)));
  return most;
}

/// Draws every frame into the pipe, which opens with the first, when the size of the pictures is known.
bool encode(const PictureInput& input, const std::string& tail, int rate) {
  const auto& frames = input.run.frames;
  const double most = thickest(input.run);
  std::optional<Pipe> pipe;
  Progress progress;
  for (std::size_t i = 0; i < frames.time.size(); ++i) {
    stop_if_interrupted("drawing the animation");
    const auto flow = flow_thickness(input.run, i);
    const auto canvas =
        draw_map({input.run, input.options, input.survey, input.score, Instant{frames.time[i], flow, most}});
    if (!pipe)
      pipe.emplace(fmt::format(
          "ffmpeg -nostdin -loglevel error -y -f rawvideo -pix_fmt bgr0 -s {}x{} -r {} -i pipe:0 -threads {} {}",
          canvas.width(), canvas.height(), rate, thread_limit(), tail));
    const auto pixels = canvas.pixels();
    const int times = i + 1 == frames.time.size() ? 1 + seconds_at_the_end * rate : 1;
    for (int k = 0; k < times; ++k)
      if (!pipe->write(pixels)) return false;
    if (progress.due()) progress.update(fmt::format("animation {}/{}", i + 1, frames.time.size()));
  }
  return pipe && pipe->close();
}

class AnimationWriter : public Writer {
 public:
  std::string name() const override { return "animation"; }
  std::vector<std::string_view> words() const override { return {"mp4", "gif"}; }
  bool wanted(const Job& job) const override { return job.options.writes("mp4") || job.options.writes("gif"); }
  void check(const Job& job) const override {
    if (!has_program("ffmpeg"))
      throw DataError({"[postprocess] outputs asks for a film: ffmpeg was not found", "it makes the film",
                       "Install it: apt-get install ffmpeg, or leave mp4 and gif out"});
    const std::size_t frames = job.run.frames.time.size();
    if (frames < 2)
      throw DataError({fmt::format("[postprocess] outputs asks for a film: the run holds {} frames", frames),
                       "a film needs two",
                       "Set frame_interval_s of [solve] and run talus-solve again, or leave mp4 and gif out"});
  }
  std::vector<std::string> names() const override { return {"animation.mp4", "animation.gif"}; }
  Files write(const Job& job) const override {
    Files files;
    for (const std::string_view format : words()) {
      if (!job.options.writes(format)) continue;
      files.push_back(job.out / fmt::format("animation.{}", format));
      PendingFile pending(files.back());
      const auto tail = encoding(format) + " " + quoted(pending.path().string());
      if (!encode(picture_of(job), tail, film_rate(job.run.frames.time.size())))
        throw DataError({files.back().string() + ": ffmpeg could not make it", "its own message is above",
                         "Free space or name another folder with --out, or leave the film out of outputs"});
      pending.commit();
    }
    return files;
  }
};

}  // namespace

std::shared_ptr<Writer> animation_writer() { return std::make_shared<AnimationWriter>(); }

}  // namespace talus::postprocess
