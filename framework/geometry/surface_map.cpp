#include "framework/registration/target.h"

#include <utility>

namespace pliant {

Target::Target(const Camera& camera, PointSet map)
    : camera(camera), points(std::move(map.points)), normals(std::move(map.normals)) {}

Target::Target(const Camera& camera, const SurfaceMap& map)
    : Target(camera, PointSet{flatten(map.points.pixels()), flatten(map.normals.pixels())}) {}

}  // namespace pliant
