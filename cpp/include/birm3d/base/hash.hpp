// FNV-1a over the bytes of a state: equal hashes mean equal bits.
#pragma once

#include <cstdint>
#include <cstring>
#include <span>

#include "birm3d/base/types.hpp"

namespace birm3d {

class Hash {
  public:
    void add(double value) {
        std::uint64_t bits;
        std::memcpy(&bits, &value, sizeof bits);
        for (int shift = 0; shift < 64; shift += 8) {
            value_ ^= (bits >> shift) & 0xffU;
            value_ *= 0x100000001b3ULL;
        }
    }
    void add(std::span<const double> values) {
        for (const double value : values)
            add(value);
    }
    void add(const Vec3& v) { add(std::span<const double>(v.data(), 3)); }
    void add(const Quat& q) { add(std::span<const double>(q.coeffs().data(), 4)); }

    std::uint64_t value() const { return value_; }

  private:
    std::uint64_t value_ = 0xcbf29ce484222325ULL;
};

}  // namespace birm3d
