#include "experiments/report/json_table.h"

namespace pliant {
namespace {

using nlohmann::ordered_json;

std::string value_of(const ordered_json& json) {
  return json.is_string() ? json.get<std::string>()
                          : json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

void add_facts(const ordered_json& json, const std::string& name, Table& table) {
  if (!json.is_object()) {
    table.rows.push_back({{name, value_of(json)}});
    return;
  }
  for (const auto& [key, value] : json.items())
    add_facts(value, name.empty() ? key : name + " " + key, table);
}

}  // namespace

Table facts_table(const std::string& title, const ordered_json& json) {
  Table table{title, {}, {}};
  add_facts(json, "", table);
  return table;
}

}  // namespace pliant
