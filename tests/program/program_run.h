#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "tests/io/test_files.h"

namespace pliant::test {

/// What came of one call of the program.
struct ProgramRun {
  int exit_code = -1;  ///< -1 when it did not end by itself, e.g. by a crash
  std::string out;
  std::string err;

  /// The lines on stderr, but for what only the first run has to say: that it builds kernels.
  std::vector<std::string> errors() const;
};

/// Calls the program itself, as a shell would.
class ProgramTest : public TestFiles {
 protected:
  /// `arguments` as words of a shell; `environment` like "NAME=value", before it. In the test's folder.
  ProgramRun call(const std::string& arguments, const std::string& environment = "") const;

  /// Calls another copy of the program from now on.
  void set_program(const std::string& path) { program_ = path; }

  /// Every file below a folder with a number that tells its bytes from others.
  std::map<std::string, std::size_t> all_of(const std::string& folder) const;

  std::string text_of(const std::string& name) const;

 private:
  std::string program_ = PLIANT_PROGRAM;
};

}  // namespace pliant::test
