// What check_symbols.cmake must find: an inline function that is no part of the namespace of its instruction set.
namespace birm3d {

__attribute__((noinline)) inline double planted_function(double x) {
    return x * x;
}

namespace BIRM3D_INSTRUCTION_SET {

double calls_planted_function(double x);

double calls_planted_function(double x) {
    return planted_function(x);
}

}  // namespace BIRM3D_INSTRUCTION_SET

}  // namespace birm3d
