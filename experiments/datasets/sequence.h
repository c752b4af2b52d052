#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "experiments/datasets/depth_camera.h"
#include "experiments/datasets/frame_files.h"
#include "experiments/datasets/frame_source.h"

namespace pliant {

/// Which frames of a sequence are taken.
struct Selection {
  int first = 1;             ///< counted from 1
  std::optional<int> count;  ///< how many at most; all by default
  int step = 1;              ///< of so many only one
};

/// Appends the rows of a selection: `first`, `frames`, `step`.
void add_selection(std::vector<Parameter>& rows);
/// `rows`, those of a selection, and those of depth and camera.
ParameterTable with_sequence(std::vector<Parameter> rows, double depth_scale);
Selection selection_of(const Parameters& section);
DepthUnits depth_units_of(const Parameters& section);

/// Frames in files, one after the other, colour at the depth's pixels.
struct Sequence {
  struct Item {
    FrameFiles files;
    double time = 0;        ///< s
    TruthFiles truth = {};  ///< of the sequence's first frame and this one
    /// From the depth camera's frame to one that stays, mm.
    std::optional<Eigen::Isometry3d> camera_pose = std::nullopt;
  };
  std::string name;
  std::vector<Item> frames;
  CameraChoice camera;
  DepthUnits units;
  std::vector<std::string> warnings;
};

/// What sources of the sequence in a folder are told alike.
struct SequenceSettings {
  std::string folder;
  Selection selection;
  DepthUnits units;
  CameraChoice camera;
};

SequenceSettings sequence_settings(const Parameters& section, CameraChoice camera);

/// Those of the frames that are selected, by the name of the folder. Throws DataError, which begins with
/// `where`, when none is left.
Sequence sequence_of(const SequenceSettings& settings, const std::vector<Sequence::Item>& frames,
                     const std::string& where);

/// What a folder is called, whether its path ends with a slash or not.
std::string name_of_folder(const std::string& path);

/// The frames that are selected. Throws DataError, which begins with `where`, when none is left.
std::vector<Sequence::Item> selected(const std::vector<Sequence::Item>& frames, const Selection& selection,
                                     const std::string& where);

/// A stream of such frames, each read when it is asked for. The first is read at once, for the size of the
/// images; what is odd about its depth, about the camera and about gaps in time is among the warnings, and so
/// are frames that see nothing: without valid depth (inside the mask), or with an empty mask. Throws
/// DataError naming the file at fault, or the sequence where it has no frame.
std::unique_ptr<DataStream> open_sequence(Sequence sequence);

}  // namespace pliant
