#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

namespace pliant {

/// A view as a figure of a page, `view` being what view_json() gives: with its picture, and what the page's
/// script needs to show it in three dimensions.
std::string view_html(const std::string& title, nlohmann::ordered_json view);

/// What the report `view` has written. Throws DataError when it cannot be read or is none.
nlohmann::ordered_json read_view(const std::filesystem::path& file);

}  // namespace pliant
