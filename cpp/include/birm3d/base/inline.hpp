// Plain: files that are compiled for several instruction sets include it (src/base/packet.hpp).
#pragma once

// Helpers of a loop must be compiled with the loop, for its instruction set.
#if defined(__GNUC__)
#define BIRM3D_INLINE inline __attribute__((always_inline))
#else
#define BIRM3D_INLINE inline
#endif
