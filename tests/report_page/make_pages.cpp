// make_pages FOLDER: pages for a browser to open, into a folder that exists.
#include <filesystem>
#include <fstream>

#include "experiments/report/chart_svg.h"
#include "experiments/report/study_page.h"
#include "tests/report/sample_study.h"

namespace {

void write(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const std::filesystem::path folder = argv[1];
  const pliant::Page page =
      pliant::study_page("Chapter 5", "Made-up numbers that show everything a page of studies can hold.",
                         pliant::sample_studies());
  write(folder / "study.html", pliant::html_page(page));
  write(folder / "static.html", pliant::html_page(page, {}));
  write(folder / "accuracy.svg", pliant::chart_svg_file(pliant::sample_lines()));
}
