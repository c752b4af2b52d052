#include "benchmarks/bench.h"

#include <benchmark/benchmark.h>

#include <nlohmann/json.hpp>
#include <ostream>
#include <utility>
#include <vector>

#include "framework/io/file.h"

namespace pliant::bench {
namespace {

/// Keeps medians and says on stderr what is going on.
class MedianReporter : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context&) override { return true; }
  void ReportRuns(const std::vector<Run>& runs) override {
    for (const auto& run : runs) {
      const bool single = run.repetitions <= 1 && run.run_type == Run::RT_Iteration;
      if (!single && run.aggregate_name != "median") continue;
      medians[run.run_name.function_name] = run.GetAdjustedRealTime();
      GetErrorStream() << "  " << run.run_name.function_name << ": " << run.GetAdjustedRealTime() << " ms\n"
                       << std::flush;
    }
  }
  std::map<std::string, double> medians;
};

}  // namespace

void Timings::add(const std::string& name, const Repeats& repeats, std::function<void()> work) {
  auto* made = benchmark::RegisterBenchmark(name.c_str(), [work = std::move(work)](benchmark::State& state) {
    for (auto _ : state) work();
  });
  made->Unit(benchmark::kMillisecond)->UseRealTime()->Repetitions(repeats.repetitions);
  if (repeats.iterations > 0)
    made->Iterations(repeats.iterations);
  else
    made->MinTime(0.2);
}

std::map<std::string, double> Timings::run() {
  std::vector<std::string> words{"pliant_bench", "--benchmark_enable_random_interleaving=true"};
  std::vector<char*> arguments;
  for (auto& word : words) arguments.push_back(word.data());
  int count = static_cast<int>(arguments.size());
  benchmark::Initialize(&count, arguments.data());
  MedianReporter reporter;
  benchmark::RunSpecifiedBenchmarks(&reporter);
  benchmark::ClearRegisteredBenchmarks();
  return reporter.medians;
}

void write_json(const Options& options, const nlohmann::ordered_json& measured) {
  if (options.json.empty()) return;
  const std::string text = measured.dump(2) + "\n";
  write_file(options.json, {text.begin(), text.end()});
}

}  // namespace pliant::bench
