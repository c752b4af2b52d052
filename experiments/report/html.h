#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace pliant {

/// The text with everything that HTML would take for its own replaced.
std::string html_escape(const std::string& text);

/// A titled part of a page. `title` and `body` are HTML. With an `id` links can lead there.
std::string html_section(const std::string& title, const std::string& body, const std::string& id = "");

/// Lines in a section of their own; nothing where there are none.
std::string html_notes(const std::vector<std::string>& notes);

/// Data for the scripts of a page, in an element that is not shown.
std::string html_data(const nlohmann::ordered_json& data);

/// The name in letters that an id may have.
std::string html_id(const std::string& name);

/// A page that needs no other file, in the light or dark colours of its reader.
struct Page {
  struct Link {
    std::string id;
    std::string title;
  };
  std::string title;  ///< a text
  std::string lead;   ///< a text
  std::string body;   ///< HTML
  std::vector<Link> contents = {};
};

/// What makes figures move: plots and views in three dimensions. Empty where it could not be made.
struct WebBundle {
  std::string script;
  std::string style;
};

/// The one that was made when the program was built.
const WebBundle& built_bundle();

/// Without a bundle figures are pictures, and the page says so. Pages without figures go without it anyway.
std::string html_page(const Page& page, const WebBundle& bundle = built_bundle());

}  // namespace pliant
