// make_pages FOLDER: pages for a browser to open, into a folder that exists.
#include <filesystem>
#include <fstream>

#include "experiments/report/chart_svg.h"
#include "experiments/report/study_page.h"
#include "tests/report/sample_study.h"
#include "tests/report/sample_view.h"

namespace {

void write(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

/// As many views as a chapter has, and as large as they should ever be.
pliant::Study ten_views(const std::filesystem::path& folder) {
  write(folder / "large_view.json", pliant::view_json(pliant::sample_view(80, 12)).dump());
  pliant::Study study;
  study.name = study.title = "views";
  for (int i = 0; i < 10; ++i) study.views.push_back({"view", folder / "large_view.json"});
  return study;
}

pliant::Study tracked_frames(const std::filesystem::path& folder) {
  write(folder / "frames.json", pliant::view_json(pliant::sample_frames(40, 5)).dump());
  pliant::Study study;
  study.name = study.title = "frames";
  study.views = {{"tracked frames", folder / "frames.json"}};
  study.charts = {pliant::sample_frames()};
  const auto png = pliant::sample_frames(4, 1).picture;
  write(folder / "errors.png", {png.begin(), png.end()});
  study.pictures = {{"errors",
                     "Figure 6.5: colour-coded error",
                     "Frames 90 and 150.",
                     {{"rigid only", folder / "errors.png"}, {"NRAdaptive", folder / "errors.png"}}}};
  return study;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const std::filesystem::path folder = argv[1];
  auto studies = pliant::sample_studies();
  write(folder / "view.json", pliant::view_json(pliant::sample_view(70, 6)).dump());
  for (auto& study : studies) study.views = {{"hand, adaptive nodes and constraints", folder / "view.json"}};
  const pliant::Page page = pliant::study_page(
      "Chapter 5", "Made-up numbers that show everything a page of studies can hold.", studies);
  write(folder / "study.html", pliant::html_page(page));
  write(folder / "static.html", pliant::html_page(page, {}));
  write(folder / "ten_views.html", pliant::make_study_page("Ten views", "", {ten_views(folder)}));
  write(folder / "frames.html", pliant::make_study_page("Tracked frames", "", {tracked_frames(folder)}));
  write(folder / "accuracy.svg", pliant::chart_svg_file(pliant::sample_lines()));
  write(folder / "chart.html", "<!DOCTYPE html><title>A chart</title><img src=\"accuracy.svg\">\n");
}
