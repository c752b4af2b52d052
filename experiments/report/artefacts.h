#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "experiments/report/table.h"
#include "experiments/report/view_data.h"
#include "framework/geometry/surface.h"

namespace pliant {

/// Numbers over the steps of a run.
struct Series {
  std::string title;
  std::string step;            ///< what the values are counted by, e.g. "outer iteration"
  std::string value;           ///< what they are, with its unit, e.g. "energy"
  std::vector<double> values;  ///< before the first step and after each
  std::string note = {};       ///< a line below
};

/// A picture as a PNG. It is drawn when it is asked for first, and once for all who show it.
class Picture {
 public:
  using Draw = std::function<std::vector<std::uint8_t>()>;
  Picture(std::string name, std::string caption, Draw draw)
      : name_(std::move(name)), caption_(std::move(caption)), draw_(std::move(draw)) {}

  const std::string& name() const { return name_; }  ///< of its file, without ending
  const std::string& caption() const { return caption_; }
  const std::vector<std::uint8_t>& png() const {
    if (png_.empty()) png_ = draw_();
    return png_;
  }

 private:
  std::string name_;
  std::string caption_;
  Draw draw_;
  mutable std::vector<std::uint8_t> png_;
};

/// A run in three dimensions. It is gathered when it is asked for first, and once for all who show it.
class View {
 public:
  using Gather = std::function<ViewData()>;
  explicit View(Gather gather) : gather_(std::move(gather)) {}

  const ViewData& data() const {
    if (!data_) data_ = gather_();
    return *data_;
  }

 private:
  Gather gather_;
  mutable std::optional<ViewData> data_;
};

/// A surface with numbers at its points. All lists have one entry a point.
struct NamedSurface {
  std::string name;                        ///< of its file, without ending
  Surface surface;                         ///< mm, camera frame
  std::vector<float> errors;               ///< mm
  std::vector<std::uint8_t> matched = {};  ///< whether a point has a match; empty where nothing is matched
  /// Where the points were when their camera saw which are neighbours; empty: where they are.
  std::vector<Eigen::Vector3f> rest = {};
};

/// What is kept of a run once its artefacts are written.
struct RunSummary {
  std::string name;
  nlohmann::ordered_json json;     ///< its entry in the file of all runs' numbers
  Table summary;                   ///< its rows in the table over all runs; without a title, the experiment's
  std::vector<std::string> notes;  ///< how it ended, and warnings: a line each
  std::string failure = {};        ///< why it is not the result that was asked for; empty: it is
  bool is_short_of_data = false;   ///< that is because its data ended or broke, and for no other reason
};

/// All that a run came to, whatever task it was: what reports show.
struct RunArtefacts : RunSummary {
  std::string lead = {};  ///< what was done, in words
  std::vector<Table> tables = {};
  std::vector<Series> series = {};
  std::vector<Picture> pictures = {};
  std::vector<NamedSurface> surfaces = {};
  std::optional<View> view = {};
  bool has_ended_early = false;                   ///< made once more, there may be more to it
  std::vector<std::filesystem::path> files = {};  ///< what the task itself wrote into the run's folder
};

/// The names of the artefacts that become files of their own.
struct ArtefactNames {
  std::vector<std::string> pictures;
  std::vector<std::string> surfaces;
  bool view = false;                    ///< whether there is one
  std::vector<std::string> files = {};  ///< that the task itself writes
};

}  // namespace pliant
