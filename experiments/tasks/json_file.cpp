#include "experiments/tasks/json_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>

#include "framework/core/error.h"
#include "framework/io/file.h"

namespace pliant {
namespace {

using nlohmann::ordered_json;

void check_finite(const ordered_json& json, const std::string& key) {
  if (json.is_number_float() && !std::isfinite(json.get<double>()))
    throw NumericalError(fmt::format("{} is {}; there is no finite answer", key, json.get<double>()));
  if (json.is_object()) {
    for (const auto& [name, value] : json.items()) check_finite(value, key.empty() ? name : key + "." + name);
  }
  if (json.is_array()) {
    for (std::size_t i = 0; i < json.size(); ++i) check_finite(json[i], fmt::format("{}[{}]", key, i));
  }
}

/// In one line where `indent` is below 0.
std::string checked_text(const ordered_json& json, int indent) {
  check_finite(json, "");
  return json.dump(indent, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

[[noreturn]] void fail(const std::string& path, int why) {
  throw DataError(fmt::format("{}: cannot be written: {}", path, std::strerror(why)));
}

/// How many bytes of a text are in lines that have an end.
std::size_t whole_lines(const std::vector<std::uint8_t>& text) {
  std::size_t size = text.size();
  while (size > 0 && text[size - 1] != '\n') --size;
  return size;
}

ordered_json parse(const std::string& text, const std::string& place) {
  ordered_json json = ordered_json::parse(text, nullptr, false);
  if (json.is_discarded()) throw DataError(place + ": is no JSON");
  return json;
}

}  // namespace

void write_json(const std::string& path, const ordered_json& json) {
  const std::string text = checked_text(json, 2);
  write_file(path, {text.begin(), text.end()});
}

ordered_json read_json(const std::string& path) {
  const auto bytes = read_file(path);
  return parse({bytes.begin(), bytes.end()}, path);
}

JsonLines::JsonLines(const std::string& path)
    : path_(path), file_(::open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666)) {
  if (file_ < 0) fail(path_, errno);
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) return;
  if (::ftruncate(file_, static_cast<off_t>(whole_lines(read_file(path_)))) == 0) return;
  const int why = errno;
  ::close(file_);
  fail(path_, why);
}

JsonLines::~JsonLines() { ::close(file_); }

void JsonLines::append(const ordered_json& json) {
  const std::string text = checked_text(json, -1);
  const off_t begin = ::lseek(file_, 0, SEEK_END);
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t more = ::write(file_, text.data() + done, text.size() - done);
    if (more >= 0) {
      done += static_cast<std::size_t>(more);
    } else if (errno != EINTR) {
      const int why = errno;
      if (::ftruncate(file_, begin) != 0) fail(path_, errno);  // a later line would be glued to this one
      fail(path_, why);
    }
  }
}

std::vector<ordered_json> read_json_lines(const std::string& path) {
  const auto bytes = read_file(path);
  const std::string text(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(whole_lines(bytes)));
  std::vector<ordered_json> values;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = text.find('\n', at);
    values.push_back(parse(text.substr(at, end - at), fmt::format("{}:{}", path, values.size() + 1)));
    at = end + 1;
  }
  return values;
}

}  // namespace pliant
