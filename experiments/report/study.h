#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "experiments/report/table.h"

namespace pliant {

/// Values over something that was varied, to be drawn as a figure.
struct Chart {
  enum class Kind {
    lines,         ///< over numbers, `Point::x`
    frames,        ///< over the frames of a stream, `Point::x`: dense, and broken where a value is not finite
    bars,          ///< side by side over words, `Point::label`
    stacked_bars,  ///< on top of each other over words
  };
  struct Point {
    double x = 0;
    std::string label;  ///< what is written at the axis
    double value = 0;   ///< the mean of `count` runs
    double spread = 0;  ///< their standard deviation
    int count = 1;
  };
  struct Series {
    std::string name;
    std::vector<Point> points;              ///< in the order of the axis
    std::optional<std::size_t> color = {};  ///< of chart_colors(); the series' own place there by default
  };
  /// A value that all others are to be held against, drawn dashed across the plot.
  struct Limit {
    std::string name;
    double value = 0;
  };

  std::string name;   ///< of its file, without ending
  std::string title;  ///< as in "Figure 5.5: accuracy over nodes, hand"
  std::string text;   ///< what it shows, in a sentence or two
  Kind kind = Kind::lines;
  std::string x_label;  ///< with its unit
  std::string y_label;
  bool log_x = false;
  bool log_y = false;
  std::vector<Series> series;
  std::vector<Limit> limits;
};

/// The names of the colours of series, in the order in which they are given out; `red` is given to none that
/// does not ask for it.
const std::vector<std::string>& chart_colors();

/// What was claimed of an experiment, and what its numbers say.
struct Finding {
  enum class Verdict { confirmed, not_confirmed, unknown };
  std::string claim;      ///< in words
  std::string scope;      ///< of what it was asked, as in "set: hand"; empty: of all
  std::string condition;  ///< as in "adaptive <= 1.05 * uniform"
  std::vector<std::pair<std::string, double>> values;  ///< of the names in the condition
  Verdict verdict = Verdict::unknown;
  std::string reason;  ///< why it is unknown; else empty
};

/// A run that a page shows in three dimensions, as its report `view` has stored it.
struct ShownView {
  std::string title;
  std::filesystem::path file;  ///< view.json in the run's folder
};

/// Pictures of runs side by side, as their report `pictures` has stored them.
struct PictureFigure {
  struct Shown {
    std::string caption;         ///< what tells the run from the others
    std::filesystem::path file;  ///< a PNG in the run's folder
  };
  std::string name;
  std::string title;
  std::string text;  ///< what it shows, in a sentence or two
  std::vector<Shown> pictures;
};

/// All that an experiment of many runs came to: what a page over several of them shows.
struct Study {
  std::string name;   ///< of the experiment
  std::string title;  ///< as in "Figures 5.5 and 5.6"
  std::string lead;   ///< what was done, in words
  std::vector<Chart> charts;
  std::vector<Table> tables;
  std::vector<Finding> findings;
  std::vector<PictureFigure> pictures = {};
  std::vector<ShownView> views;
  std::vector<std::string> notes;      ///< failed runs and warnings: a line each
  std::string experiment;              ///< the resolved experiment, as YAML
  nlohmann::ordered_json environment;  ///< versions, device, seed, date
};

}  // namespace pliant
