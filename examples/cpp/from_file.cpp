// A vehicle prepared in Python, crashed in C++:
//
//   python -c "import birm3d; birm3d.Vehicle.preset('passenger_car').export_core('car.txt')"
//   birm3d_from_file car.txt 15 60       speed (m/s), angle between path and wall (deg)
//
// The wall is rigid, without end, with a friction coefficient of 0.2. The same scene in Python has the same state hash.
#include <algorithm>
#include <birm3d/model/vehicle_text.hpp>
#include <birm3d/simulation/simulation.hpp>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <iterator>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>

namespace {

double number(const char* text) {
    char* end = nullptr;
    const double value = std::strtod(text, &end);
    if (end == text || *end != '\0') throw std::invalid_argument(std::string("no number: ") + text);
    return value;
}

}  // namespace

int main(int argc, char** argv) try {
    using namespace birm3d;
    if (argc != 4) {
        std::fprintf(stderr, "usage: %s VEHICLE SPEED ANGLE\n", argv[0]);
        return 2;
    }
    std::ifstream file(argv[1]);
    if (!file) {
        std::fprintf(stderr, "no file %s\n", argv[1]);
        return 1;
    }
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    const double speed = number(argv[2]);
    const double angle = number(argv[3]) * (std::numbers::pi / 180.0);

    const auto vehicle = std::make_shared<const Vehicle>(vehicle_of_text(text));
    const auto wall = std::make_shared<const Barrier>(Barrier::wall(0.2, Vec3::Zero(), 0.0));
    const Settings settings = usual_settings(*vehicle, wall.get());
    Simulation simulation(Scene(vehicle, wall, Approach{speed, angle, 0.0, 0.0}, settings, {}));
    simulation.run([] {});

    double crush = 0.0;
    for (const UnitState& unit : simulation.state().units)
        for (const TrussBlockState& block : unit.trusses.block)
            for (const double deflection : block.peak_deflection)
                crush = std::max(crush, deflection);
    std::printf("crush %.4f m after %llu steps\n", crush,
                static_cast<unsigned long long>(simulation.state().statistics.steps));
    std::printf("state hash %016llx\n", static_cast<unsigned long long>(simulation.state().hash()));
    return 0;
} catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
}
