#pragma once

#include <functional>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace pliant::bench {

struct Options {
  std::string json;    ///< file for the rows; none when empty
  std::string only;    ///< measure only what has this in its name
  std::string data;    ///< folder of data beside the usual ones (pair mode)
  bool quick = false;  ///< fewer sizes and repetitions
};

/// How often a piece of work is timed.
struct Repeats {
  int repetitions = 5;  ///< the median over these counts
  int iterations = 0;   ///< in each; 0: as many as fill a fifth of a second
};

/// Pieces of work to be timed by Google Benchmark in one go, repetitions interleaved, so that they see the
/// same machine.
class Timings {
 public:
  void add(const std::string& name, const Repeats& repeats, std::function<void()> work);
  /// Median milliseconds of each, by name.
  std::map<std::string, double> run();
};

/// Writes what a mode measured to the file that `options` names, if any. Throws DataError when it cannot.
void write_json(const Options& options, const nlohmann::ordered_json& measured);

int run_solver_mode(const Options& options);
int run_kernels_mode(const Options& options);
int run_pair_mode(const Options& options);
int run_render_mode(const Options& options);
int run_pose_mode(const Options& options);
int run_tracking_mode(const Options& options);
int run_relocalisation_mode(const Options& options);
int run_head_forest_mode(const Options& options);

}  // namespace pliant::bench
