#pragma once

#include <malloc.h>

#include <cstddef>

namespace pliant::test {

/// What is allocated on the host now; 0 where the C library does not tell, as under sanitizers.
inline std::size_t host_bytes() { return mallinfo2().uordblks + mallinfo2().hblkhd; }

}  // namespace pliant::test
