#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "experiments/report/table.h"

namespace pliant {

/// A row for each value within an object, named by the keys that lead there.
Table facts_table(const std::string& title, const nlohmann::ordered_json& json);

}  // namespace pliant
