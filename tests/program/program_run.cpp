#include "tests/program/program_run.h"

#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <functional>
#include <sstream>

namespace pliant::test {

std::vector<std::string> ProgramRun::errors() const {
  std::vector<std::string> lines;
  std::istringstream stream(err);
  for (std::string line; std::getline(stream, line);)
    if (line.find("building kernels") == std::string::npos) lines.push_back(line);
  return lines;
}

ProgramRun ProgramTest::call(const std::string& arguments, const std::string& environment) const {
  const std::string command = "cd '" + file("") + "' && " + environment + " '" + program_ + "' " + arguments +
                              " >stdout.txt 2>stderr.txt </dev/null";
  const int status = std::system(command.c_str());
  ProgramRun run;
  if (WIFEXITED(status)) run.exit_code = WEXITSTATUS(status);
  run.out = text_of("stdout.txt");
  run.err = text_of("stderr.txt");
  return run;
}

std::map<std::string, std::size_t> ProgramTest::all_of(const std::string& folder) const {
  std::map<std::string, std::size_t> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(file(folder)))
    if (!entry.is_directory()) {
      const auto bytes = read_file(entry.path().string());
      files[entry.path().string()] = std::hash<std::string>()({bytes.begin(), bytes.end()});
    }
  return files;
}

std::string ProgramTest::text_of(const std::string& name) const {
  const auto bytes = read_file(file(name));
  return {bytes.begin(), bytes.end()};
}

}  // namespace pliant::test
