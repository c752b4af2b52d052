#pragma once

#include <filesystem>
#include <string>

namespace pliant {

/// The folder in which kernels are kept between runs: the one that PoCL takes from the environment
/// (POCL_CACHE_DIR, else below XDG_CACHE_HOME or HOME), where it can be written. PoCL has no device where it
/// cannot, and without HOME would shut other users out of a folder in /tmp; so then POCL_CACHE_DIR is set,
/// for this process, to `pliant-<user id>` below the folder for temporary files, which is made for this user
/// alone. Empty when that cannot be had either. Not thread-safe, because it may change the environment; to be
/// called before the first call of OpenCL.
std::filesystem::path open_kernel_cache();

/// Why there may be no device although a driver is installed; empty when the kernel cache can be written.
std::string kernel_cache_problem();

/// Whether an earlier run has noted, in this cache, that it built a program. `program`: all that tells it
/// from others, device and driver among it.
bool is_noted(const std::filesystem::path& cache, const std::string& program);
/// A note that cannot be written is left out: it is only good for telling what takes so long.
void note(const std::filesystem::path& cache, const std::string& program);

}  // namespace pliant
