#pragma once

#include <stdexcept>
#include <string>

namespace pliant {

/// Base of every error the framework raises on purpose; `what()` is one clear line for the user.
class Error : public std::runtime_error {
 public:
  Error(const std::string& message, int exit_code) : std::runtime_error(message), exit_code_(exit_code) {}

  /// The exit code of the command line for this family of errors.
  int exit_code() const { return exit_code_; }

 private:
  int exit_code_;
};

/// An experiment file that cannot be used; the message names file:line:column (one line per error).
class ConfigError : public Error {
 public:
  explicit ConfigError(const std::string& message) : Error(message, 2) {}
};

/// Data that cannot be read, used or written; the message names the file.
class DataError : public Error {
 public:
  explicit DataError(const std::string& message) : Error(message, 3) {}
};

/// A live source that ended while it was read, as a camera that was unplugged. What was read before is good.
class SourceLost : public DataError {
 public:
  using DataError::DataError;
};

/// No usable OpenCL device, a failed kernel build (with its log) or a failed device call.
class DeviceError : public Error {
 public:
  explicit DeviceError(const std::string& message) : Error(message, 4) {}
};

/// A computation that has no finite answer.
class NumericalError : public Error {
 public:
  explicit NumericalError(const std::string& message) : Error(message, 5) {}
};

}  // namespace pliant
