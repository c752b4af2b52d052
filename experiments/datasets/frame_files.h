#pragma once

#include <optional>
#include <string>
#include <vector>

#include "framework/evaluation/truth.h"
#include "framework/geometry/frame.h"

namespace pliant {

/// The files of one frame. A path is empty where there is no file.
struct FrameFiles {
  std::string depth;  ///< 16-bit PNG
  std::string color;
  std::string mask;
};

/// How depth in files is to be understood.
struct DepthUnits {
  double scale = 1;                                ///< mm a unit of the depth images
  std::optional<double> max_depth = std::nullopt;  ///< mm; farther depth is dropped
};

/// Reads the images, depth in mm. Throws DataError naming the file when one cannot be read, when a mask has
/// not the depth's size; also when the colour has not the depth's size, unless a camera of its own sees it.
Frame read_frame(const FrameFiles& files, const DepthUnits& units, bool color_has_own_camera = false);

/// Throws DataError naming the file when a frame sees nothing: its mask is empty, or no depth is left (inside
/// the mask).
void check_sees_something(const Frame& frame, const FrameFiles& files, const DepthUnits& units);

/// The files of what is known of a pair. A path is empty where there is no file.
struct TruthFiles {
  std::string scene_flow;         ///< metres; without it nothing is known
  std::string optical_flow = {};  ///< pixels
  std::string visible = {};       ///< a mask of what the target shows
};

/// Reads what is known of the frame `source`, whose depth is that of the file `depth`. Throws DataError
/// naming the file at fault when the sizes differ or the scene flow says nothing of any point of the source.
PairTruth read_truth(const TruthFiles& files, const Frame& source, const std::string& depth);

/// "the depth image PATH".
std::string depth_named(const std::string& path);

[[noreturn]] void refuse_size(const std::string& path, int width, int height, const std::string& which,
                              int other_width, int other_height);

/// Throws DataError naming `path` unless an image of so many pixels has the size of the one it belongs to,
/// which `which` names. Both have width() and height().
template <class AnyImage, class Other>
void check_size(const AnyImage& image, const std::string& path, const Other& other,
                const std::string& which) {
  if (image.width() != other.width() || image.height() != other.height())
    refuse_size(path, image.width(), image.height(), which, other.width(), other.height());
}

/// Appends.
void add(std::vector<std::string> more, std::vector<std::string>& warnings);

}  // namespace pliant
