#include "framework/segmentation/haar.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <opencv2/imgproc.hpp>
#include <opencv2/objdetect.hpp>
#include <tuple>
#include <vector>

#include "framework/core/error.h"
#include "framework/core/nearest.h"
#include "framework/imaging/segmentation.h"
#include "framework/segmentation/parts.h"
#include "framework/segmentation/window_at_depth.h"

namespace pliant {
namespace {

namespace fs = std::filesystem;

constexpr const char* cascade_folder = "/usr/share/opencv4/haarcascades";

struct HaarSettings {
  double scale_factor = 0;
  int min_neighbours = 0;
  int least_size = 0;     // pixels of the colour image
  double depth_band = 0;  // mm
  int speck = 0;          // pixels of the depth image
  int margin = 0;         // likewise
};

/// The cascade that a section names.
std::string cascade_file(const Parameters& section) {
  if (section.has("cascade_file")) return section.text("cascade_file");
  const std::string& name = section.text("cascade");
  const fs::path file = fs::path(cascade_folder) / (name + ".xml");
  if (fs::exists(file)) return file.string();
  std::vector<std::string> names;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(cascade_folder, none))
    names.push_back(entry.path().stem().string());
  throw DataError(fmt::format(
      "{}: there is no such cascade{}; install Debian's package opencv-data, or name a file by cascade_file",
      file.string(), suggestion(name, names)));
}

cv::CascadeClassifier load_cascade(const std::string& file) {
  cv::CascadeClassifier cascade;
  try {
    cascade.load(file);
  } catch (const cv::Exception&) {
    // OpenCV throws for what is no XML and stays empty for other XML.
  }
  if (cascade.empty()) throw DataError(file + ": not a cascade that OpenCV can read");
  return cascade;
}

cv::Mat gray_of(const ColorImage& color) {
  cv::Mat gray(color.height(), color.width(), CV_8U);
  const cv::Mat rgb(color.height(), color.width(), CV_8UC3, const_cast<Rgb*>(color.data()));
  cv::cvtColor(rgb, gray, cv::COLOR_RGB2GRAY);
  return gray;
}

class Haar : public Segmentation {
 public:
  Haar(const std::string& file, const HaarSettings& settings)
      : settings_(settings), cascade_(load_cascade(file)) {}

  std::optional<Region> find(const Frame& frame, const Rig& rig) const override {
    if (frame.color.empty())
      throw DataError("segmentation haar: the frames have no colour to find a face in");
    for (const cv::Rect& face : faces(frame.color)) {
      const auto window = window_at_depth({face.x, face.y, face.width, face.height}, frame, rig,
                                          settings_.depth_band, settings_.speck);
      if (window) return Region{widened(*window, settings_.margin, rig.depth)};
    }
    return std::nullopt;
  }

 private:
  /// The largest first.
  std::vector<cv::Rect> faces(const ColorImage& color) const {
    std::vector<cv::Rect> found;
    cascade_.detectMultiScale(gray_of(color), found, settings_.scale_factor, settings_.min_neighbours, 0,
                              {settings_.least_size, settings_.least_size});
    // Which comes first depends on OpenCV's threads.
    const auto rank = [](const cv::Rect& face) { return std::tuple(-face.area(), face.y, face.x); };
    std::sort(found.begin(), found.end(),
              [&](const cv::Rect& a, const cv::Rect& b) { return rank(a) < rank(b); });
    return found;
  }

  HaarSettings settings_;
  mutable cv::CascadeClassifier cascade_;  // detection writes into its buffers
};

HaarSettings read_settings(const Parameters& section) {
  const auto whole = [&](const char* name) { return static_cast<int>(section.integer(name)); };
  return {section.real("scale_factor"), whole("min_neighbours"), whole("least_size"),
          section.real("depth_band"),   whole("speck"),          whole("margin")};
}

}  // namespace

void register_haar(Registry& registry) {
  registry.add<Segmentation>(
      "haar", "A face that the Viola-Jones detector finds in the colour image [thesis 3.1]",
      {
          text("cascade", "haarcascade_frontalface_default")
              .doc("one of those of Debian's package opencv-data, without .xml"),
          path("cascade_file").optional().doc("a cascade of OpenCV in a file of your own, instead"),
          real("scale_factor", 1.1).range(1.01, 2).doc("between the sizes that are looked for"),
          integer("min_neighbours", 5)
              .range(0, 100)
              .doc("how many overlapping finds make a face; fewer find more, and more that is none"),
          integer("least_size", 60).unit("pixel").range(20, 4096).doc("of a face in the colour image"),
          real("depth_band", 150)
              .unit("mm")
              .above(0)
              .doc("how far from the depth of the face's middle it may reach"),
          speck_parameter(),
          margin_parameter(),
      },
      [](const Parameters& section, const Registry&) {
        return std::make_unique<Haar>(cascade_file(section), read_settings(section));
      });
}

}  // namespace pliant
