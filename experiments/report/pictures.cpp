#include <memory>

#include "experiments/report/report.h"
#include "experiments/report/reports.h"
#include "framework/io/file.h"

namespace pliant {
namespace {

class PicturesReport : public Report {
 public:
  std::vector<std::string> files(const ArtefactNames& names) const override {
    std::vector<std::string> files;
    for (const std::string& name : names.pictures) files.push_back(name + ".png");
    return files;
  }
  std::vector<std::filesystem::path> write(const RunArtefacts& run,
                                           const std::filesystem::path& folder) const override {
    std::vector<std::filesystem::path> files;
    for (const Picture& picture : run.pictures) {
      files.push_back(folder / (picture.name() + ".png"));
      write_file(files.back().string(), picture.png());
    }
    return files;
  }
};

}  // namespace

void register_pictures_report(Registry& registry) {
  registry.add<Report>("pictures", "Depth, errors and the deformation graph as PNG pictures", {},
                       [](const Parameters&, const Registry&) { return std::make_unique<PicturesReport>(); });
}

}  // namespace pliant
