// A hash of the numbers of a state: equal hashes mean equal bits.
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
        add(bits);
    }
    // The map of the hash is one-to-one: the product spreads low bits upwards, the shift spreads high bits downwards.
    void add(std::uint64_t bits) {
        value_ = (value_ ^ bits) * 0x9e3779b97f4a7c15ULL;
        value_ ^= value_ >> 32;
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
