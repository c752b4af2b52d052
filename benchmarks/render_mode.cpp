#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <ctime>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <vector>

#include "benchmarks/bench.h"
#include "experiments/datasets/surface_color.h"
#include "framework/core/stopwatch.h"
#include "framework/geometry/mesh_renderer.h"
#include "framework/geometry/point_set.h"

namespace pliant::bench {
namespace {

using nlohmann::ordered_json;
using Points = std::vector<Eigen::Vector3d>;

const Camera camera{525, 525, 319.5, 239.5, 640, 480};

/// A dented ball that fills the height of the image, before and after it is dented further.
struct Ball {
  std::vector<Eigen::Vector3i> triangles;
  Points before;
  Points after;
};

Points dented(int rings, double dent, const Eigen::Vector3d& centre) {
  Points points;
  for (int j = 0; j <= rings; ++j) {
    for (int i = 0; i < 2 * rings; ++i) {
      const double turn = std::numbers::pi * j / rings;
      const double angle = std::numbers::pi * i / rings;
      const double radius = 250 + dent * std::sin(5 * angle) * std::sin(4 * turn);
      points.emplace_back(centre + radius * Eigen::Vector3d(std::sin(turn) * std::cos(angle), -std::cos(turn),
                                                            std::sin(turn) * std::sin(angle)));
    }
  }
  return points;
}

Ball make_ball(int rings) {
  Ball ball{{}, dented(rings, 10, {0, 0, 700}), dented(rings, 25, {15, -10, 690})};
  const int around = 2 * rings;
  for (int j = 0; j < rings; ++j) {
    for (int i = 0; i < around; ++i) {
      const int a = j * around + i;
      const int b = j * around + (i + 1) % around;
      ball.triangles.emplace_back(a, b, a + around);
      ball.triangles.emplace_back(b, b + around, a + around);
    }
  }
  return ball;
}

/// The least of several times: what else the machine does only adds to them.
template <class Work>
double least_time(int repetitions, Work work) {
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < repetitions; ++i) {
    const Stopwatch watch;
    work();
    least = std::min(least, watch.milliseconds());
  }
  return least;
}

/// Frames of a stream: upload the vertices, render, and read what a frame and its truth have.
ordered_json measure(const std::string& name, int rings, int repetitions, Device& device) {
  const Ball ball = make_ball(rings);
  const MeshRenderer renderer(device, ball.triangles, ball.before.size());
  const SurfaceColor color(SurfaceColor::Kind::rich, 1);
  const Array<float> rest = flatten(ball.before);
  const MeshView first = renderer.render(rest, camera);
  std::vector<float> depth(static_cast<std::size_t>(camera.width) * camera.height);
  const auto device_frame = [&] {
    const Array<float> vertices = flatten(ball.after);
    const MeshView view = renderer.render(vertices, camera);
    const Array<cl_uchar> colors = color.paint(device, view, renderer.interpolate(view, rest));
    const DeviceMotion motion = renderer.move(first, vertices, view);
    view.depth.copy_to(depth.data());
    read_colors(colors, camera);
    motion.read(camera);
  };
  const auto reference_frame = [&] {
    const auto seen = render_mesh(ball.after, ball.triangles, camera);
    for (const Fragment& fragment : seen.pixels())
      if (fragment.triangle >= 0)
        color.color_of(interpolate(fragment, ball.triangles, ball.before).cast<float>());
    true_motion(render_mesh(ball.before, ball.triangles, camera), ball.triangles, camera, ball.after, camera,
                depth_of(seen));
  };
  device_frame();
  device.finish();
  const std::clock_t begin = std::clock();
  const double time = least_time(repetitions, device_frame);
  const double processor = 1e3 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC / repetitions;
  const double reference = least_time(std::max(repetitions / 10, 2), reference_frame);
  device.measure_stages(true);
  std::map<std::string, double> kernels;
  for (int i = 0; i < repetitions; ++i) {
    device_frame();
    for (const auto& [kernel, kernel_time] : device.take_kernel_times()) {
      const auto known = kernels.try_emplace(kernel, kernel_time).first;
      known->second = std::min(known->second, kernel_time);
    }
  }
  device.measure_stages(false);
  return {{"name", name},
          {"time_ms", time},
          {"triangles", ball.triangles.size()},
          {"reference_time_ms", reference},
          {"processor_ms", processor},  // of all cores together: whatever else the machine does
          {"kernels_ms", kernels}};
}

}  // namespace

int run_render_mode(const Options& options) {
  Device device;
  auto rows = ordered_json::array();
  const int repetitions = options.quick ? 20 : 100;
  for (const auto& [name, rings] :
       {std::pair{"2500 triangles", 25}, {"25000 triangles", 79}, {"100000 triangles", 158}})
    if (std::string(name).find(options.only) != std::string::npos && !(options.quick && rings > 100))
      rows.push_back(measure(name, rings, repetitions, device));
  fmt::print("640x480 with depth, colour, scene flow, optical flow and visibility\n");
  for (const auto& row : rows) {
    fmt::print("{:<18} {:8.2f} ms, reference {:8.1f} ms; {:.2f} ms of processors;",
               row["name"].get<std::string>(), row["time_ms"].get<double>(),
               row["reference_time_ms"].get<double>(), row["processor_ms"].get<double>());
    for (const auto& [kernel, time] : row["kernels_ms"].items())
      fmt::print(" {} {:.2f}", kernel, time.get<double>());
    fmt::print("\n");
  }
  write_json(options, rows);
  return 0;
}

}  // namespace pliant::bench
