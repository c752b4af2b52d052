#pragma once

#include <memory>
#include <string>
#include <vector>

#include "framework/geometry/frame.h"
#include "framework/geometry/rig.h"
#include "framework/imaging/segmentation.h"

namespace pliant::test {

/// The segmentation that a section of an experiment file describes, e.g. "{type: haar, margin: 3}".
std::unique_ptr<Segmentation> segmentation_of(const std::string& section);

/// A head seen by two cameras that stand and look apart.
struct RenderedFace {
  Rig rig;
  Frame frame;
  DepthImage color_depth;  ///< mm, what the colour camera would measure, exactly
};

/// `rest`: further keys of the source `head`, e.g. ", sensor: {axial: 1}".
RenderedFace rendered_face(const std::string& rest = "");

/// Where the depth image shows what a window of the colour image shows: the bounding window of the pixels
/// that the surface points of all its pixels project to.
PixelWindow true_window(const PixelWindow& color_window, const RenderedFace& face);

/// The largest distance between borders of two windows, pixels.
int difference(const PixelWindow& a, const PixelWindow& b);

}  // namespace pliant::test
