#pragma once

#include <string>

namespace pliant {

/// The text with everything that HTML would take for its own replaced.
std::string html_escape(const std::string& text);

/// A titled part of a page. `title` and `body` are HTML.
std::string html_section(const std::string& title, const std::string& body);

/// A page that needs no other file, in the light or dark colours of its reader. `title` and `lead` are
/// texts, `body` is HTML.
std::string html_page(const std::string& title, const std::string& lead, const std::string& body);

}  // namespace pliant
