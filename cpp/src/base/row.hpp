// Eight numbers side by side, in registers of whatever width the file is compiled for. Plain arithmetic in a
// fixed order and without contraction: every width gives the same bits.
//
// For files that are compiled once for each instruction set: nothing here, and nothing such a file includes,
// may leave a symbol that another file could share, for the linker would keep one of them for all processors.
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

// Told by the build, as flags for a whole build (-march=native) may add instructions to any of them.
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

inline constexpr std::size_t row_length = 8;
inline constexpr std::size_t parts = row_length / BIRM3D_REGISTER_LENGTH;

struct Row {
    using Register = double __attribute__((vector_size(8 * BIRM3D_REGISTER_LENGTH)));
    using InMemory __attribute__((aligned(8), may_alias)) = Register;
    Register part[parts];

    Row() = default;
    BIRM3D_INLINE Row(double value) {
        for (std::size_t p = 0; p < parts; ++p)
            part[p] = value - Register{};  // is value, where value + 0.0 need not be
    }
    BIRM3D_INLINE static Row load(const double* from) {
        Row row;
        for (std::size_t p = 0; p < parts; ++p)
            row.part[p] = *reinterpret_cast<const InMemory*>(from + p * BIRM3D_REGISTER_LENGTH);
        return row;
    }
    BIRM3D_INLINE void store(double* to) const {
        for (std::size_t p = 0; p < parts; ++p)
            *reinterpret_cast<InMemory*>(to + p * BIRM3D_REGISTER_LENGTH) = part[p];
    }
};

#define BIRM3D_ROW_OPERATOR(op)                                 \
    BIRM3D_INLINE Row operator op(const Row& a, const Row& b) { \
        Row row;                                                \
        for (std::size_t p = 0; p < parts; ++p)                 \
            row.part[p] = a.part[p] op b.part[p];               \
        return row;                                             \
    }
BIRM3D_ROW_OPERATOR(+)
BIRM3D_ROW_OPERATOR(-)
BIRM3D_ROW_OPERATOR(*)
BIRM3D_ROW_OPERATOR(/)
#undef BIRM3D_ROW_OPERATOR

// As in base/select.hpp.
BIRM3D_INLINE Row where_above(const Row& a, const Row& b, const Row& yes, const Row& no) {
    Row row;
    for (std::size_t p = 0; p < parts; ++p)
        row.part[p] = a.part[p] > b.part[p] ? yes.part[p] : no.part[p];
    return row;
}

BIRM3D_INLINE Row greater(const Row& a, const Row& b) {
    return where_above(a, b, a, b);
}

BIRM3D_INLINE Row square_root(const Row& a) {
    Row row;
    for (std::size_t p = 0; p < parts; ++p)
        for (std::size_t k = 0; k < BIRM3D_REGISTER_LENGTH; ++k)
            row.part[p][k] = __builtin_sqrt(a.part[p][k]);
    return row;
}

BIRM3D_INLINE Row lesser(const Row& a, const Row& b) {
    return where_above(a, b, b, a);
}

BIRM3D_INLINE bool any_above(const Row& a, const Row& b) {
#if defined(__AVX512F__)
    return _mm512_cmp_pd_mask(a.part[0], b.part[0], _CMP_GT_OQ) != 0;
#else
    using Two = long long __attribute__((vector_size(16)));
    Two any[row_length / 2];
    for (std::size_t p = 0; p < parts; ++p) {
        const auto above = a.part[p] > b.part[p];
        __builtin_memcpy(any + p * (row_length / 2 / parts), &above, sizeof(above));
    }
    const Two both = (any[0] | any[1]) | (any[2] | any[3]);
    return (both[0] | both[1]) != 0;
#endif
}

BIRM3D_INLINE double least_of(const Row& row) {
    alignas(64) double v[row_length];
    row.store(v);
    for (std::size_t half = row_length / 2; half > 0; half /= 2)
        for (std::size_t i = 0; i < half; ++i)
            v[i] = v[half + i] < v[i] ? v[half + i] : v[i];
    return v[0];
}

BIRM3D_INLINE double sum_of(const Row& row) {
    alignas(64) double v[row_length];
    row.store(v);
    return row_sum(v);
}

}  // namespace birm3d::BIRM3D_INSTRUCTION_SET
