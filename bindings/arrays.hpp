// NumPy in and out. In: (n), (n, 3) float64 arrays, shapes checked by name. Out: read-only views that keep
// their owner alive, no copies.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <string>
#include <vector>

#include "birm3d/base/error.hpp"
#include "birm3d/base/types.hpp"

namespace birm3d::bindings {

namespace py = pybind11;

using InputArray = py::array_t<double, py::array::c_style | py::array::forcecast>;

inline std::string shape_text(const py::array& array) {
    std::string text = "(";
    for (py::ssize_t i = 0; i < array.ndim(); ++i)
        text += (i ? ", " : "") + std::to_string(array.shape(i));
    return text + ")";
}

inline std::vector<Vec3> points(const InputArray& array, const char* name) {
    if (array.ndim() != 2 || array.shape(1) != 3)
        refuse(std::string(name) + " shape", "(n, 3)", shape_text(array));
    std::vector<Vec3> result;
    result.reserve(static_cast<std::size_t>(array.shape(0)));
    const auto view = array.unchecked<2>();
    for (py::ssize_t i = 0; i < array.shape(0); ++i)
        result.emplace_back(view(i, 0), view(i, 1), view(i, 2));
    return result;
}

inline Column numbers(const InputArray& array, const char* name) {
    if (array.ndim() != 1) refuse(std::string(name) + " shape", "(n,)", shape_text(array));
    return {array.data(), array.data() + array.size()};
}

inline Vec3 vector(const InputArray& array, const char* name) {
    if (array.ndim() != 1 || array.shape(0) != 3)
        refuse(std::string(name) + " shape", "(3,)", shape_text(array));
    return {array.at(0), array.at(1), array.at(2)};
}

inline Mat3 matrix(const InputArray& array, const char* name) {
    if (array.ndim() != 2 || array.shape(0) != 3 || array.shape(1) != 3)
        refuse(std::string(name) + " shape", "(3, 3)", shape_text(array));
    Mat3 result;
    for (py::ssize_t i = 0; i < 3; ++i)
        for (py::ssize_t j = 0; j < 3; ++j)
            result(static_cast<int>(i), static_cast<int>(j)) = array.at(i, j);
    return result;
}

using OutputArray = py::array_t<double>;

inline OutputArray read_only(OutputArray array) {
    array.attr("setflags")(py::arg("write") = false);
    return array;
}

// Views onto memory that `owner` holds.
inline OutputArray view(const Column& values, const py::handle& owner) {
    return read_only(OutputArray(static_cast<py::ssize_t>(values.size()), values.data(), owner));
}
inline OutputArray view(const std::vector<Vec3>& values, const py::handle& owner) {
    static_assert(sizeof(Vec3) == 3 * sizeof(double));
    const double* first = values.empty() ? nullptr : values.front().data();
    return read_only(OutputArray({static_cast<py::ssize_t>(values.size()), py::ssize_t{3}}, first, owner));
}

// Small results that are copied.
inline OutputArray copy(const Vec3& v) {
    return read_only(OutputArray(3, v.data()));
}
inline OutputArray copy(const Mat3& m) {
    OutputArray result({3, 3});
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            result.mutable_at(i, j) = m(i, j);
    return read_only(std::move(result));
}

}  // namespace birm3d::bindings
