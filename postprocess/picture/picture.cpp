// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The map as a picture, and over time as a film, encoded by ffmpeg.
#include "postprocess/picture/picture.hpp"

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <sstream>

#include <fmt/format.h>
#include <unistd.h>

#include "common/stage/machine.hpp"
#include "common/stage/stage.hpp"
#include "postprocess/score/thalweg.hpp"
#include "postprocess/writers/job.hpp"

namespace talus::postprocess {
namespace fs = std::filesystem;
namespace {

// All in pixels at 200 dpi.
constexpr double left = 120, top = 172, right = 40, bottom = 118;
constexpr double gap = 36, sidebar = 470;
constexpr double largest_width = 1560, largest_height = 1420, least_height = 1130;

Box map_box(const Window& window) {
  const double scale = std::min(largest_width / window.width(), largest_height / window.height());
  return {left, top, std::round(window.width() * scale), std::round(window.height() * scale)};
}

/// The part of the maps that is drawn, in the deposit's place the flow of an instant, or what a search found to fail.
RunMaps shown_maps(const PictureInput& input, const Window& window) {
  const bool search = shows_search(input);
  if (!input.instant && !search) return cropped(input.run.maps, window);
  auto maps = input.run.maps;
  maps.deposit_thickness = search ? maps.critical_thickness : input.instant->thickness;
  if (search) maps.peak_thickness.assign(maps.peak_thickness.size(), 0);  // nothing has moved
  return cropped(maps, window);
}

Canvas draw_map(const PictureInput& input) {
  const auto window = affected_window(input.run.maps, input.options, input.survey);
  const View view{window, map_box(window)};
  const auto maps = shown_maps(input, window);
  const auto limits =
      class_limits(input.options.classes, input.instant ? input.instant->thickest : largest(maps.deposit_thickness));
  const ContourLevels contours = contour_levels(view, maps);
  const double width = left + view.box.width + gap + sidebar + right;
  const std::vector<std::string> belief =
      input.instant ? std::vector<std::string>{} : belief_lines(input.score, width - left - right);
  const double below = top + std::max(view.box.height, least_height) + bottom;
  const double height = below + belief_line * static_cast<double>(belief.size() + (belief.empty() ? 0 : 1));

  Canvas canvas(static_cast<int>(width), static_cast<int>(height));
  canvas.clip(view.box);
  draw_ground(canvas, view, maps, limits);
  draw_contours(canvas, view, maps, contours);
  draw_outlines(canvas, view, maps, input);
  if (input.hazard != nullptr) draw_hazard(canvas, view, input.run.maps.grid, *input.hazard);
  draw_places(canvas, view, input.run.summary.places);
  canvas.unclip();
  canvas.frame(view.box, {{0.1, 0.1, 0.12}, 2.5, {}, 1});
  draw_coordinates(canvas, view);
  draw_title(canvas, input, left, 30, width - left - right);
  draw_sidebar(canvas, input, view, limits, contours.interval,
               {left + view.box.width + gap, top, sidebar, below - top - bottom});
  draw_belief(canvas, belief, left, below - 50);
  draw_footer(canvas, input, left, height - 26);
  if (input.instant) draw_time(canvas, input.instant->time, view);
  return canvas;
}

PictureInput picture_of(const Job& job) { return {job.run, job.options, job.survey, job.score, {}, &job.hazard}; }

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

/// MP4 that every player takes (even sizes, 4:2:0); GIF smaller, with a palette of its own, not dithered.
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

constexpr const char* film_formats[] = {"mp4", "gif"};

void check_film(const Job& job) {
  if (!has_program("ffmpeg"))
    throw DataError({"[postprocess] outputs asks for a film: ffmpeg was not found", "it makes the film",
                     "Install it: apt-get install ffmpeg, or leave mp4 and gif out"});
  const std::size_t frames = job.run.frames.time.size();
  if (frames < 2)
    throw DataError({fmt::format("[postprocess] outputs asks for a film: the run holds {} frames", frames),
                     "a film needs two",
                     "Set frame_interval_s of [solve] and run talus-solve again, or leave mp4 and gif out"});
}

Files write_films(const Job& job) {
  Files files;
  for (const std::string_view format : film_formats) {
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

}  // namespace

Writer picture_writer() {
  return {.name = "map picture",
          .names = {"map.png"},
          .write = [](const Job& job) { return Files{write_file(job, "map.png", map_picture(picture_of(job)))}; },
          .outdated = std::vector<std::string>{},
          .stands_alone = true};
}

std::string map_picture(const PictureInput& input) { return draw_map(input).png(); }

Writer animation_writer() {
  return {.name = "animation",
          .names = {"animation.mp4", "animation.gif"},
          .write = write_films,
          .words = {std::begin(film_formats), std::end(film_formats)},
          .check = check_film};
}

}  // namespace talus::postprocess
