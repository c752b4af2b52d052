#include "experiments/report/view_html.h"

#include <fmt/format.h>

#include "experiments/report/html.h"
#include "framework/core/error.h"
#include "framework/io/file.h"

namespace pliant {

using nlohmann::ordered_json;

std::string view_html(const std::string& title, ordered_json view) {
  const std::string picture = view["picture"].get<std::string>();
  view.erase("picture");
  return html_section(
      html_escape(title),
      fmt::format("<figure class=\"view-figure\" data-scale=\"{}\"><div class=\"view-static\">"
                  "<img alt=\"{}\" src=\"data:image/png;base64,{}\"></div>\n{}</figure>\n",
                  view["scale"].get<double>(), html_escape(title), picture, html_data(view)));
}

ordered_json read_view(const std::filesystem::path& file) {
  const auto bytes = read_file(file.string());
  ordered_json view = ordered_json::parse(bytes.begin(), bytes.end(), nullptr, false);
  if (!view.is_object() || !view.contains("format"))
    throw DataError(file.string() + ": is no view; expected what the report 'view' writes");
  if (view["format"] != 1 || !view.contains("picture"))
    throw DataError(file.string() + ": is a view of another version of Pliant; run its experiment again");
  return view;
}

}  // namespace pliant
