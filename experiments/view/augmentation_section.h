#pragma once

#include "experiments/view/augmentation.h"
#include "framework/core/parameters.h"

namespace pliant {

/// The rows of a section that describes a virtual object and where it is fixed, as in
/// `augmentation: {mesh: hat.glb, at: [0, -120, 700]}`.
ParameterTable augmentation_table();

/// What such a section describes. An object without turn stands upright and looks at the camera of the first
/// frame, as figures of data sources do: its y axis goes up in the image, its z axis towards the camera.
/// Throws DataError naming the file when it cannot be read.
Augmentation::Object read_object(const Parameters& section);

/// The object of a section over the frames of a rig.
Augmentation make_augmentation(const Parameters& section, Device& device, const Rig& rig);

}  // namespace pliant
