// A test harness of one page. One test file is one program and one ctest entry:
//
//     #include "check.hpp"
//
//     TEST("a falling body") {
//         CHECK(body.position.z() < 0.0);
//         CHECK_CLOSE(body.velocity.z(), -9.80665, 1e-12, "one exact step; rounding only");
//         CHECK_THROWS(Settings{.time_step = -1.0}.validate(), std::invalid_argument);
//     }
//
// A failed check prints its place and values and the case goes on. An escaped exception fails the case.
// The header defines main(), which returns non-zero if a check failed or if there was none at all.
#pragma once

#include <cmath>
#include <cstdio>
#include <exception>
#include <vector>

namespace check {

struct Case {
    const char* name;
    void (*body)();
};

inline std::vector<Case>& cases() {
    static std::vector<Case> all;
    return all;
}

struct Register {
    Register(const char* name, void (*body)()) { cases().push_back({name, body}); }
};

inline long n_checks = 0;
inline long n_failed = 0;

inline bool record(bool passed, const char* file, int line, const char* text) {
    ++n_checks;
    if (!passed) {
        ++n_failed;
        std::printf("%s:%d: failed: %s\n", file, line, text);
    }
    return passed;
}

// |actual - expected| <= tolerance, absolute, in the unit of the values. False for NaN. The reason says where the
// tolerance comes from.
inline void close(double actual, double expected, double tolerance, const char* reason, const char* file,
                  int line, const char* text) {
    if (!record(std::abs(actual - expected) <= tolerance, file, line, text)) {
        std::printf("    actual %.17g, expected %.17g, difference %.3g, tolerance %.3g (%s)\n", actual,
                    expected, actual - expected, tolerance, reason);
    }
}

inline int run() {
    for (const Case& c : cases()) {
        const long failed_before = n_failed;
        try {
            c.body();
        } catch (const std::exception& e) {
            ++n_failed;
            std::printf("escaped exception: %s\n", e.what());
        } catch (...) {
            ++n_failed;
            std::printf("escaped exception of unknown type\n");
        }
        std::printf("%s  %s\n", n_failed == failed_before ? "ok  " : "FAIL", c.name);
    }
    std::printf("%zu cases, %ld checks, %ld failed\n", cases().size(), n_checks, n_failed);
    return n_failed == 0 && n_checks > 0 ? 0 : 1;
}

}  // namespace check

#define CHECK_JOIN_(a, b) a##b
#define CHECK_JOIN(a, b) CHECK_JOIN_(a, b)

#define TEST(name)                                                                                           \
    static void CHECK_JOIN(check_body_, __LINE__)();                                                         \
    static const check::Register CHECK_JOIN(check_case_, __LINE__)(name, CHECK_JOIN(check_body_, __LINE__)); \
    static void CHECK_JOIN(check_body_, __LINE__)()

// Variadic, because a condition may hold commas outside brackets: Vec3{1, 2, 3} == x.
#define CHECK(...) check::record(static_cast<bool>(__VA_ARGS__), __FILE__, __LINE__, #__VA_ARGS__)

#define CHECK_CLOSE(actual, expected, tolerance, reason) \
    check::close(actual, expected, tolerance, reason, __FILE__, __LINE__, #actual " close to " #expected)

#define CHECK_THROWS(expression, exception)                                                 \
    do {                                                                                    \
        bool check_thrown = false;                                                          \
        try {                                                                               \
            static_cast<void>(expression);                                                  \
        } catch (const exception&) {                                                        \
            check_thrown = true;                                                            \
        }                                                                                   \
        check::record(check_thrown, __FILE__, __LINE__, #expression " throws " #exception); \
    } while (false)

int main() {
    return check::run();
}
