#include <memory>

#include "experiments/report/report.h"
#include "experiments/report/reports.h"
#include "framework/io/file.h"

namespace pliant {
namespace {

constexpr const char* name = "view.json";

class ViewReport : public Report {
 public:
  std::vector<std::string> files(const ArtefactNames& names) const override {
    return names.view ? std::vector<std::string>{name} : std::vector<std::string>{};
  }
  std::vector<std::filesystem::path> write(const RunArtefacts& run,
                                           const std::filesystem::path& folder) const override {
    if (!run.view) return {};
    const std::filesystem::path file = folder / name;
    const std::string text = view_json(run.view->data()).dump() + "\n";
    write_file(file.string(), {text.begin(), text.end()});
    return {file};
  }
};

}  // namespace

void register_view_report(Registry& registry) {
  registry.add<Report>("view", "view.json: the run in three dimensions, for pages over several runs", {},
                       [](const Parameters&, const Registry&) { return std::make_unique<ViewReport>(); });
}

}  // namespace pliant
