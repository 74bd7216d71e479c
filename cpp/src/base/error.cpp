#include "birm3d/base/error.hpp"

#include <charconv>
#include <cmath>

namespace birm3d {

std::string to_text(double value) {
    char buffer[32];
    const auto end = std::to_chars(buffer, buffer + sizeof buffer, value).ptr;
    return {buffer, end};
}

std::string to_text(double value, int digits) {
    char buffer[32];
    const auto end =
        std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::general, digits).ptr;
    return {buffer, end};
}

void refuse(const std::string& name, const std::string& limit, const std::string& value) {
    throw InvalidArgument(name + " must be " + limit + ", got " + value);
}

void refuse(const std::string& name, const std::string& limit, double value) {
    refuse(name, limit, to_text(value));
}

double require_finite(const char* name, double value) {
    if (!std::isfinite(value)) refuse(name, "finite", value);
    return value;
}

double require_positive(const char* name, double value) {
    if (!(std::isfinite(value) && value > 0.0)) refuse(name, "finite and > 0", value);
    return value;
}

double require_not_negative(const char* name, double value) {
    if (!(std::isfinite(value) && value >= 0.0)) refuse(name, "finite and >= 0", value);
    return value;
}

double require_within(const char* name, double value, double low, double high) {
    if (!(value >= low && value <= high))
        refuse(name, "within " + to_text(low) + " to " + to_text(high), value);
    return value;
}

UnstableError::UnstableError(const std::string& text, double time_step_, double limit_, double time_)
    : std::runtime_error(text), time_step(time_step_), limit(limit_), time(time_) {}

}  // namespace birm3d
