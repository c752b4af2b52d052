#pragma once

#include <exception>
#include <filesystem>

#include "experiments/datasets/frame_source.h"
#include "framework/core/log.h"

namespace pliant {

/// How files of a sequence are called, and what they count in.
enum class SequenceLayout {
  /// As of the TUM RGB-D benchmark: depth/TIME.png (16-bit, 5000 units a metre), rgb/TIME.png, depth.txt,
  /// rgb.txt, associations.txt, and groundtruth.txt (the camera's position in metres and its quaternion, in a
  /// frame that stays).
  tum,
  /// As of DeepDeform: depth/NUMBER.png (16-bit, mm), color/NUMBER.png.
  deepdeform
};

struct WrittenSequence {
  int frames = 0;
  /// The SourceLost that a live source ended with; what came before it is written.
  std::exception_ptr lost = nullptr;
};

/// Writes all frames of a stream into a folder, which is made where it is not there, with what is known of
/// the first frame and each other one: scene_flow/object_FIRST_NUMBER.sflow (metres),
/// optical_flow/object_FIRST_NUMBER.oflow (pixels) and visible/object_FIRST_NUMBER.png, numbers from 0 on;
/// masks, where frames have some, as mask/NUMBER_object.png; and intrinsics.txt (4x4). Colour of a camera of
/// its own is carried to the depth's pixels, as both layouts have it. Depth is rounded to the units that
/// files count in. Streams are read ahead where they may be, so that a camera drops no frame when a file
/// takes long. Throws DataError as the stream does, and naming the file that cannot be written.
WrittenSequence write_sequence(DataStream& stream, SequenceLayout layout, const std::filesystem::path& folder,
                               const ProgressSink& progress = {});

}  // namespace pliant
