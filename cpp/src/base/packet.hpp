// A packet of eight numbers in registers of the width that the file is compiled for. Arithmetic is in a fixed order
// and without contraction: every width gives the same bits.
//
// For files that are compiled once for each instruction set. Neither this header nor any other that such a file
// includes may define a shared symbol: the linker would keep one copy for all processors. tests/cpp/instruction_sets holds this.
#pragma once

#include <cstddef>

#include "base/node_sums.hpp"
#include "birm3d/base/block_size.hpp"

#if defined(__AVX512F__)
#include <immintrin.h>
#endif

#if !defined(__GNUC__)
#error "BIRM3D's kernels need the vector types of GCC or Clang"
#endif

// The build defines it. Compiler macros do not tell, as flags for a whole build (-march=native) may add instructions.
#if !defined(BIRM3D_INSTRUCTION_SET)
#define BIRM3D_INSTRUCTION_SET baseline
#endif

#if defined(__AVX512F__)
#define BIRM3D_REGISTER_LENGTH 8
#elif defined(__AVX2__)
#define BIRM3D_REGISTER_LENGTH 4
#else
#define BIRM3D_REGISTER_LENGTH 2
#endif

namespace birm3d::BIRM3D_INSTRUCTION_SET {

inline constexpr std::size_t packet_length = 8;
inline constexpr std::size_t parts = packet_length / BIRM3D_REGISTER_LENGTH;

struct Packet {
    using Register = double __attribute__((vector_size(8 * BIRM3D_REGISTER_LENGTH)));
    using InMemory __attribute__((aligned(8), may_alias)) = Register;
    Register part[parts];

    Packet() = default;
    BIRM3D_INLINE Packet(double value) {
        for (std::size_t p = 0; p < parts; ++p)
            part[p] = value - Register{};  // equals value; value + 0.0 would turn -0.0 into 0.0
    }
    BIRM3D_INLINE static Packet load(const double* from) {
        Packet row;
        for (std::size_t p = 0; p < parts; ++p)
            row.part[p] = *reinterpret_cast<const InMemory*>(from + p * BIRM3D_REGISTER_LENGTH);
        return row;
    }
    BIRM3D_INLINE void store(double* to) const {
        for (std::size_t p = 0; p < parts; ++p)
            *reinterpret_cast<InMemory*>(to + p * BIRM3D_REGISTER_LENGTH) = part[p];
    }
};

#define BIRM3D_ROW_OPERATOR(op)                                          \
    BIRM3D_INLINE Packet operator op(const Packet& a, const Packet& b) { \
        Packet row;                                                      \
        for (std::size_t p = 0; p < parts; ++p)                          \
            row.part[p] = a.part[p] op b.part[p];                        \
        return row;                                                      \
    }
BIRM3D_ROW_OPERATOR(+)
BIRM3D_ROW_OPERATOR(-)
BIRM3D_ROW_OPERATOR(*)
BIRM3D_ROW_OPERATOR(/)
#undef BIRM3D_ROW_OPERATOR

// As in base/select.hpp.
BIRM3D_INLINE Packet where_above(const Packet& a, const Packet& b, const Packet& yes, const Packet& no) {
    Packet row;
    for (std::size_t p = 0; p < parts; ++p)
        row.part[p] = a.part[p] > b.part[p] ? yes.part[p] : no.part[p];
    return row;
}

BIRM3D_INLINE Packet greater(const Packet& a, const Packet& b) {
    return where_above(a, b, a, b);
}

BIRM3D_INLINE Packet square_root(const Packet& a) {
    Packet row;
    for (std::size_t p = 0; p < parts; ++p)
        for (std::size_t k = 0; k < BIRM3D_REGISTER_LENGTH; ++k)
            row.part[p][k] = __builtin_sqrt(a.part[p][k]);
    return row;
}

BIRM3D_INLINE Packet lesser(const Packet& a, const Packet& b) {
    return where_above(a, b, b, a);
}

BIRM3D_INLINE bool any_above(const Packet& a, const Packet& b) {
#if defined(__AVX512F__)
    return _mm512_cmp_pd_mask(a.part[0], b.part[0], _CMP_GT_OQ) != 0;
#else
    using Two = long long __attribute__((vector_size(16)));
    Two any[packet_length / 2];
    for (std::size_t p = 0; p < parts; ++p) {
        const auto above = a.part[p] > b.part[p];
        __builtin_memcpy(any + p * (packet_length / 2 / parts), &above, sizeof(above));
    }
    const Two both = (any[0] | any[1]) | (any[2] | any[3]);
    return (both[0] | both[1]) != 0;
#endif
}

BIRM3D_INLINE double least_of(const Packet& row) {
    alignas(64) double v[packet_length];
    row.store(v);
    for (std::size_t half = packet_length / 2; half > 0; half /= 2)
        for (std::size_t i = 0; i < half; ++i)
            v[i] = v[half + i] < v[i] ? v[half + i] : v[i];
    return v[0];
}

BIRM3D_INLINE double sum_of(const Packet& row) {
    alignas(64) double v[packet_length];
    row.store(v);
    return packet_sum(v);
}

}  // namespace birm3d::BIRM3D_INSTRUCTION_SET
