#include "experiments/program/command_line.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <exception>
#include <sstream>
#include <string>
#include <vector>

#include "experiments/program/commands.h"
#include "experiments/program/make_data.h"
#include "experiments/program/output.h"
#include "experiments/program/reproduce.h"
#include "experiments/program/train.h"
#include "experiments/program/view.h"
#include "experiments/runner/version.h"
#include "framework/core/error.h"
#include "framework/core/nearest.h"

namespace pliant {
namespace {

constexpr int bad_arguments = 2;

constexpr const char* overview = R"(Real-time adaptive non-rigid registration of depth maps.

First steps:
  pliant reproduce --quick            everything that can be reproduced, in short
  pliant reproduce chapter5           the experiments of chapter 5 of the thesis
  pliant run experiments/sheet.yaml   one experiment; results in out/sheet
  pliant track experiments/track_head.yaml    frames fused into a model; trajectory, model, page
  pliant view out/sheet --open        its page, with the run in three dimensions
  pliant components                   what experiment files can name
  pliant data make hand               frames with exact truth as files, in out/hand

From the source tree the launcher ./pliant builds what has changed first, and has two commands more:
  ./pliant test [CTEST OPTION...]     builds and runs the tests
  ./pliant bench [OPTION...]          builds and runs the benchmarks
)";

constexpr const char* run_examples = R"(
Examples:
  pliant run experiments/sheet.yaml
  pliant run experiments/sheet.yaml --set data.amplitude=30 --set solver=ceres_lm --out out/bent
  pliant run my.yaml --data ~/recordings
  pliant run my.yaml --repeat 9       the time of a run after the first, and its spread

A sweep that was interrupted, or in which a run failed, goes on from its finished runs when it is run again.

An experiment on data of your own is a file like this one:
  extends: methods/ed.yaml
  data:
    type: rgbd_pair
    source: {depth: a.png, color: a.jpg, mask: a_mask.png}   # color and mask are optional
    target: {depth: b.png, color: b.jpg}
    intrinsics: intrinsics.txt

Files that it names are looked for beside it, then below --data, the variable PLIANT_DATA and data/ of the
project. Exit codes: 2 configuration, 3 data, 4 device, 5 numerical.
)";

constexpr const char* track_examples = R"(
Examples:
  pliant track experiments/track_head.yaml
  pliant track my.yaml --data ~/recordings --out out/mine
  pliant track my.yaml --show                         in a window, live
  pliant track my.yaml --set record.video=true        video.avi, without a screen

Every frame is in frames.jsonl, frames.csv and trajectory.txt as soon as it is tracked. Ctrl-C, or a camera that
is unplugged (exit code 3), ends with the model and the report of what there is.
)";

constexpr const char* check_examples = R"(
Example:
  pliant check my.yaml --set seed=2    every error of the file at once, with its place; exit code 2
)";

constexpr const char* compare_examples = R"(
Example:
  pliant compare experiments/compare_solvers.yaml --set compare.repetitions=3

The file lists the solvers under names of their own:
  solvers:
    device: gauss_newton
    ceres: {type: ceres_lm, linear_solver: cgnr}
)";

constexpr const char* components_examples = R"(
Examples:
  pliant components                          every component by kind, with a line about each
  pliant components solver gauss_newton      its parameters: units, defaults, ranges
  pliant components --json > schema.json     a JSON Schema with which editors complete experiment files
)";

constexpr const char* view_examples = R"(
Example:
  pliant view out/sheet --open    without --open it only says where the page is
)";

constexpr const char* devices_examples = R"(
Example:
  pliant devices    then choose one by a part of its name: pliant run my.yaml --set device=pthread
)";

constexpr const char* make_data_examples = R"(
Examples:
  pliant data make head --set 'data.target=[smile=1]' --set data.frames=30 --out out/smile
  pliant data make my.yaml --layout tum --out out/my_sequence

Writes depth (16-bit PNG), colour (PNG), the camera and, where the source knows it, the true motion from the
first frame to each other one: scene flow, optical flow and what is visible.
)";

constexpr const char* train_examples = R"(
Examples:
  pliant train head_forest --out my.forest
  pliant train experiments/train_head_forest.yaml --set heads=40 --set seed=2 --out my.forest

A forest finds heads in depth maps, for relocalizer: {type: head_forest, file: my.forest}. The same settings give
the same bytes.
)";

constexpr const char* reproduce_examples = R"(
Example:
  pliant reproduce --quick --out out/quick --data ~/data
  pliant reproduce chapter5

What is interrupted goes on from its finished runs when it is called again.

Experiments on data that is not found are skipped, and say where it was looked for.
)";

/// Values that the arguments are parsed into.
struct Arguments {
  ExperimentOptions experiment;
  std::string kind;
  std::string name;
  bool json = false;
  ReproduceOptions reproduce;
  std::string layout = "deepdeform";
  std::string result;
  bool open = false;
};

void add_set(CLI::App& command, ExperimentOptions& options, const std::string& label,
             const std::string& what) {
  command.add_option(label, options.file, what)->required();
  command.add_option("--set", options.sets, "Lays one value over the file, e.g. data.noise=1; repeatable")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
}

void add_set_and_data(CLI::App& command, ExperimentOptions& options, const std::string& label = "FILE.yaml",
                      const std::string& what = "The experiment") {
  add_set(command, options, label, what);
  command
      .add_option("--data", options.data, "Folder in which files that the experiment names are looked for")
      ->type_name("DIR");
}

void add_out(CLI::App& command, ExperimentOptions& options, const std::string& fallback) {
  command.add_option("--out", options.out, "Folder for the results; " + fallback + " by default")
      ->type_name("DIR");
}

CLI::App* add_command(CLI::App& app, const std::string& name, const std::string& what,
                      const std::string& examples) {
  CLI::App* command = app.add_subcommand(name, what);
  command->footer(examples);
  return command;
}

void add_commands(CLI::App& app, Arguments& arguments) {
  auto& experiment = arguments.experiment;
  auto* reproduce =
      add_command(app, "reproduce", "Makes the experiments that come with Pliant, and a page over them",
                  reproduce_examples);
  auto& reproduced = arguments.reproduce;
  reproduce->add_option("CHAPTER", reproduced.chapter, "Only those of one chapter: chapter5");
  reproduce->add_flag("--quick", reproduced.quick, "The short form: some minutes");
  reproduce
      ->add_option("--out", reproduced.out, "Folder for the results; out/reproduce or out/CHAPTER by default")
      ->type_name("DIR");
  reproduce->add_option("--data", reproduced.data, "Folder with recorded data")->type_name("DIR");
  reproduce->callback([&] { reproduce_command(reproduced); });

  auto* run = add_command(app, "run", "Registers what an experiment file describes", run_examples);
  add_set_and_data(*run, experiment);
  add_out(*run, experiment, "out/<name of the experiment>");
  run->add_option("--repeat", experiment.repeats,
                  "Times so many runs after one that is not timed; tells median, least and most")
      ->type_name("N")
      ->check(CLI::Range(1, 1000));
  run->callback([&] { run_command(experiment); });

  auto* track =
      add_command(app, "track", "Tracks the frames of a stream and fuses them into a model", track_examples);
  add_set_and_data(*track, experiment);
  add_out(*track, experiment, "out/<name of the experiment>");
  track->add_flag("--show", experiment.show,
                  "A window with the frames while they are tracked: space pauses, q, Esc or closing it ends");
  track->callback([&] { track_command(experiment); });

  auto* check =
      add_command(app, "check", "Tries everything of an experiment without registering", check_examples);
  add_set_and_data(*check, experiment);
  check->callback([&] { check_command(experiment); });

  auto* compare =
      add_command(app, "compare", "The same frozen problem through every solver of a file", compare_examples);
  add_set_and_data(*compare, experiment);
  add_out(*compare, experiment, "out/<name of the experiment>");
  compare->callback([&] { compare_command(experiment); });

  auto* components = add_command(app, "components", "What experiment files can name, with all parameters",
                                 components_examples);
  components->add_option("KIND", arguments.kind, "Only this kind, e.g. solver");
  components->add_option("NAME", arguments.name, "Only this component, with its parameters");
  components->add_flag("--json", arguments.json, "A JSON Schema of experiment files, for editors");
  components->callback([&] { components_command(arguments.kind, arguments.name, arguments.json); });

  auto* train = add_command(app, "train", "Trains the forest that finds heads, on heads that it renders",
                            train_examples);
  add_set(*train, experiment, "head_forest|FILE.yaml", "With the usual settings, or with those of a file");
  train->add_option("--out", experiment.out, "The file to be written; head_forest.forest by default")
      ->type_name("FILE");
  train->callback([&] { train_command(experiment); });

  auto* view = add_command(app, "view", "The page of a result, made if it has none", view_examples);
  view->add_option("RESULT_DIR", arguments.result, "The folder of a result, or of one of its runs")
      ->required();
  view->add_flag("--open", arguments.open, "Opens it in the browser");
  view->callback([&] { view_command(arguments.result, arguments.open); });

  auto* devices = add_command(app, "devices", "The OpenCL devices of this machine", devices_examples);
  devices->callback([] { devices_command(); });
}

void add_data_commands(CLI::App& app, Arguments& arguments) {
  auto* data = app.add_subcommand("data", "Makes data: see pliant data make --help");
  data->require_subcommand(1);
  auto* make = add_command(*data, "make", "Writes the frames of a data source, and their truth, as files",
                           make_data_examples);
  add_set_and_data(*make, arguments.experiment, "NAME|FILE.yaml",
                   "A data source, or an experiment whose data is taken");
  add_out(*make, arguments.experiment, "out/<name>");
  make->add_option("--layout", arguments.layout, "deepdeform (the default) or tum")
      ->check(CLI::IsMember({"deepdeform", "tum"}));
  make->callback([&] { make_data_command(arguments.experiment, arguments.layout); });
}

std::vector<std::string> command_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const auto* command : app.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(command->get_name());
  return names;
}

/// A first word that is no command gets an answer of its own: CLI11 would only call it unexpected.
void check_command_word(const CLI::App& app, int argc, char** argv) {
  if (argc < 2 || argv[1][0] == '-') return;
  const std::string word = argv[1];
  const auto names = command_names(app);
  if (std::find(names.begin(), names.end(), word) != names.end()) return;
  if (word == "test" || word == "bench")
    throw ConfigError(fmt::format("'{0}' needs the source tree: run ./pliant {0} there", word));
  throw ConfigError(fmt::format("unknown command '{}'; expected one of {}{}", word, fmt::join(names, ", "),
                                suggestion(word, names)));
}

int parse(CLI::App& app, int argc, char** argv) {
  try {
    check_command_word(app, argc, argv);
    app.parse(argc, argv);
    return 0;
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {  // --help, --version
      std::ostringstream text;
      app.exit(error, text);
      write_output(text.str());
      return 0;
    }
    write_message(
        fmt::format("error: {}; see pliant {}--help\n", error.what(),
                    app.get_subcommands().empty() ? "" : app.get_subcommands().front()->get_name() + " "));
    return bad_arguments;
  }
}

}  // namespace

int run_command_line(int argc, char** argv) {
  CLI::App app(overview, "pliant");
  app.set_version_flag("--version", fmt::format("pliant {} ({})", version(), commit()));
  app.require_subcommand(1);
  Arguments arguments;
  add_commands(app, arguments);
  add_data_commands(app, arguments);
  try {
    const int exit_code = parse(app, argc, argv);
    check_output();
    return exit_code;
  } catch (const ConfigError& error) {
    write_message(fmt::format("{}\n", error.what()));  // its lines begin with a place that editors understand
    return error.exit_code();
  } catch (const Error& error) {
    write_message(fmt::format("error: {}\n", error.what()));
    return error.exit_code();
  } catch (const std::exception& error) {
    write_message(fmt::format("error: unforeseen: {}\n", error.what()));
    return 1;
  }
}

}  // namespace pliant
