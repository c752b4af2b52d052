#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "framework/deformation/graph.h"

namespace pliant {

/// A run in three dimensions, step by step: mm, in the frame of a camera. Steps are the iterations of a
/// registration, or frames that were tracked, which are seen in the frame of their model.
struct ViewData {
  struct Mesh {
    std::vector<Eigen::Vector3f> points;  ///< fewer than 65536
    std::vector<Eigen::Vector3i> triangles;
  };
  /// Of a cell of a hierarchical graph: its rim along the source's surface, from point to point.
  struct Outline {
    int level = 1;
    std::vector<std::pair<int, int>> lines;  ///< of points of the source
  };
  struct Graph {
    std::vector<Edge> edges;
    std::vector<Outline> cells;
  };
  struct Step {
    int number = 0;                       ///< of the frame, or of the outer iteration; 0: as it was aligned
    std::vector<Eigen::Vector3f> points;  ///< of the source, where they are then
    std::vector<float> nearest;           ///< of these, mm to the nearest target point; NaN where unknown
    std::vector<float> truth;             ///< mm to the true position; empty without truth
    std::size_t graph = 0;                ///< which of `graphs`
    std::vector<Eigen::Vector3f> nodes;   ///< where they are then
    /// Some of the matched constraints: from where the point is to where it should go.
    std::vector<std::pair<Eigen::Vector3f, Eigen::Vector3f>> constraints;
    std::size_t constraint_count = 0;  ///< of all matched ones

    // Of a frame that was tracked, whose `points` are its own and whose `nearest` leads to the model:
    std::string state;                    ///< what became of it
    std::vector<int> cells;               ///< of each point: its place in the grid of `frames`, row by row
    std::vector<Eigen::Vector3f> camera;  ///< where it is, then the corners of a picture before it
  };
  /// What frames that were tracked have in common.
  struct Frames {
    int columns = 1;                    ///< of the grid that their points are pixels of; below 65536 cells
    float gap = 0;                      ///< mm: neighbours in the grid that are further apart are not joined
    std::vector<Eigen::Vector3f> path;  ///< of the camera
  };

  Mesh source;                        ///< as it was given
  Mesh target;                        ///< of what lies around the source
  std::vector<std::uint8_t> matched;  ///< per point of the source: whether it has a match at the end
  std::vector<Graph> graphs;
  std::vector<Step> steps;       ///< in the order of their numbers
  std::optional<Frames> frames;  ///< where steps are frames: `target` is the model, and there is no source
  std::size_t result = 0;        ///< which of them is the result
  float scale = 1;               ///< mm: what the colours of errors end at
  std::vector<std::uint8_t> picture;  ///< a PNG that stands in where nothing can be turned
};

/// About so many bytes of points may a view have, so that a page can hold ten.
inline constexpr std::size_t view_bytes = 900'000;

/// How many points of the source a view of so many steps should have at most.
std::size_t view_points(std::size_t steps, bool has_truth);

/// As the page's script reads it: numbers as base64 of little-endian integers, positions in steps of 1/65535
/// of the largest side of the box around them (far below 0.1 mm), errors as their square roots in 255 steps.
nlohmann::ordered_json view_json(const ViewData& view);

}  // namespace pliant
