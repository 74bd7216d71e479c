// Sine and cosine with the same bits everywhere. Libraries differ in the last bit, and the state of a run would with them.
#pragma once

namespace birm3d {

struct SineCosine {
    double sine, cosine;
};

// Of an angle of at most 90 degrees to either side (rad), to a few roundings: Taylor's series of an eighth of it, doubled three
// times.
inline SineCosine sine_cosine(double angle) {
    const double x = 0.125 * angle, y = x * x;
    double sine =
        x * (1.0 - y / 6.0 * (1.0 - y / 20.0 * (1.0 - y / 42.0 * (1.0 - y / 72.0 * (1.0 - y / 110.0)))));
    double cosine =
        1.0 -
        y / 2.0 *
            (1.0 - y / 12.0 * (1.0 - y / 30.0 * (1.0 - y / 56.0 * (1.0 - y / 90.0 * (1.0 - y / 132.0)))));
    for (int doubled = 0; doubled < 3; ++doubled) {
        const double twice = 2.0 * sine;
        const SineCosine of_twice{twice * cosine, 1.0 - twice * sine};
        sine = of_twice.sine, cosine = of_twice.cosine;
    }
    return {sine, cosine};
}

}  // namespace birm3d
