// Errors the core reports: every message names the argument, the limit and the value received.
#pragma once

#include <stdexcept>
#include <string>

namespace birm3d {

class InvalidArgument : public std::invalid_argument {
  public:
    using std::invalid_argument::invalid_argument;
};

// A fixed step is longer than the limit of stability, or that limit is too short to compute the scene with.
class UnstableError : public std::runtime_error {
  public:
    UnstableError(const std::string& text, double time_step, double limit, double time);

    double time_step;  // s, the step that was to be taken
    double limit;      // s, that of steps at that instant
    double time;       // s, when it happened
};

// Each returns its value, so that it can be used in initialisers.
double require_finite(const char* name, double value);
double require_positive(const char* name, double value);
double require_not_negative(const char* name, double value);
double require_within(const char* name, double value, double low, double high);

[[noreturn]] void refuse(const std::string& name, const std::string& limit, double value);
[[noreturn]] void refuse(const std::string& name, const std::string& limit, const std::string& value);

// Shortest text that reads back as the same number; with `digits`, rounded to so many.
std::string to_text(double value);
std::string to_text(double value, int digits);

}  // namespace birm3d
