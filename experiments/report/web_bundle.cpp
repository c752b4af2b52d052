#include "experiments/report/html.h"
#include "web/report.css.embed.h"
#include "web/report.js.embed.h"

namespace pliant {

const WebBundle& built_bundle() {
  static const WebBundle bundle{std::string(embedded::web_report_js), std::string(embedded::web_report_css)};
  return bundle;
}

}  // namespace pliant
