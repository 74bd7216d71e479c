// The text of a vehicle: numbers to the bit, and what is wrong named by its line.
#include "birm3d/model/vehicle_text.hpp"

#include <limits>
#include <stdexcept>
#include <string>

#include "check.hpp"

using namespace birm3d;

namespace {

const std::string block =
    "birm3d-vehicle 8\n"
    "cornering_stiffness 0x1.8p+2\n"
    "edge_flank_factor 0x1p-2\n"
    "units 1\n"
    "mass 0x1.f4p+9\n"
    "inertia 0x1p+9 0x0p+0 0x0p+0 0x0p+0 0x1p+9 0x0p+0 0x0p+0 0x0p+0 0x1p+9\n"
    "mass_center_height 0x1p-1\n"
    "offset 0x0p+0 0x0p+0 0x0p+0\n"
    "wheels 1\n"
    "0x1p+0 -0x1p-1 -0x1.999999999999ap-3 0x1.3333333333333p-2 0x1p+13 0x1p-1 0x1p+16 0x1p+11 0x1p-3 0x1p-4 "
    "0x1p-1 "
    "0x1p-5 0x1p-6 0x1p-7 0x1p-8\n"
    "boxes 0\n"
    "mesh_origin 0x1p+0 0x0p+0 0x0p+0\n"
    "mesh_wheels 0\n"
    "rate_sensitivity 0x0p+0\n"
    "indentation_length 0x0p+0\n"
    "curves 1\n"
    "2 0x1p+22 inf 0x1p-2 0x0p+0\n"
    "0x0p+0 0x1p+20\n"
    "0x1p-3 0x1p+21\n"
    "trusses 2\n"
    "0x1p+1 0x1p-2 0x0p+0 0x1p+0 0x1p-2 0x0p+0 0 0x1p-1 -1 -1\n"
    "0x1p+1 -0x1p-2 0x0p+0 0x1p+0 -0x1p-2 0x0p+0 0 0x1p-1 -1 -1\n"
    "joints 0\n"
    "end\n";

std::string with(const std::string& old, const std::string& other) {
    std::string text = block;
    return text.replace(text.find(old), old.size(), other);
}

std::string refusal(const std::string& text) {
    try {
        vehicle_of_text(text);
    } catch (const std::invalid_argument& error) {
        return error.what();
    }
    return "";
}

bool names(const std::string& message, const std::string& part) {
    return message.find(part) != std::string::npos;
}

}  // namespace

TEST("numbers are read to the bit") {
    const Vehicle vehicle = vehicle_of_text(block);
    CHECK(vehicle.units.size() == 1 && vehicle.joints.empty());
    const Unit& unit = vehicle.units[0];
    CHECK(unit.body.mass == 1000.0 && unit.body.inertia(1, 1) == 512.0);
    CHECK(unit.wheels[0].center == Vec3(1.0, -0.5, -0.2) && unit.wheels[0].radius == 0.3);
    CHECK(unit.wheels[0].breakaway == 8192.0 && unit.wheels[0].travel == 0.5);
    const Suspension& suspension = unit.wheels[0].suspension;
    CHECK(suspension.stiffness == 65536.0 && suspension.damping == 2048.0);
    CHECK(suspension.at_rest == 0.125 && suspension.bump == 0.0625 && suspension.roll_ratio == 0.5);
    CHECK(unit.wheels[0].steering_time == 0.03125 && unit.wheels[0].tread_radius == 0.015625);
    CHECK(unit.wheels[0].camber_ratio == 0.0078125 && unit.wheels[0].rolling_resistance == 0.00390625);
    CHECK(unit.trusses.friction_share[0][1] == 0.25);
    const Settings settings = usual_settings(vehicle, nullptr);
    CHECK(settings.cornering_stiffness == 6.0 && settings.edge_flank_factor == 0.25);
    CHECK(unit.mass_center_height == 0.5);
    CHECK(unit.trusses.count == 2);
    CHECK(unit.trusses.node(0).x() == 1.0);  // 2 m, seen from 1 m
    CHECK(unit.trusses.block[0].k_unloading[0] == 0.5 * 4194304.0);
}

TEST("all digits count, and signs") {
    const auto mass = [](const std::string& text) {
        return vehicle_of_text(with("0x1.f4p+9", text)).units[0].body.mass;
    };
    CHECK(mass("0x1.fffffffffffffp+99") == 0x1.fffffffffffffp+99);
    CHECK(mass("0x1.91eb851eb851fp+1") == 3.14);
    CHECK(names(refusal(with("0x1.f4p+9", "-0x1p+0")), "mass"));
    CHECK(names(refusal(with("0x1.f4p+9", "0x0.0p+0")), "mass"));
}

TEST("what is wrong is named by its line") {
    CHECK(names(refusal(with("0x1.f4p+9", "1000")), "line 5"));
    CHECK(names(refusal(with("0x1.f4p+9", "0x1.8q+9")), "line 5"));
    CHECK(names(refusal(with("0x1.f4p+9", "0x1.123456789abcdefp+9")), "line 5"));
    CHECK(names(refusal(with("0x1.f4p+9", "nan")), "line 5"));
    CHECK(names(refusal(with("birm3d-vehicle 8", "birm3d-vehicle 1")), "version 8"));
    CHECK(names(refusal(with("birm3d-vehicle", "vehicle")), "line 1"));
    CHECK(names(refusal(with("trusses 2", "trusses 3")), "line 23"));
    CHECK(names(refusal(with("trusses 2", "trusses -1")), ">= 0"));
    CHECK(names(refusal(with("joints 0", "joints 1\nglued 0 1")), "fifth_wheel, welded or sliding"));
    CHECK(names(refusal(block + "more"), "nothing after"));
    CHECK(names(refusal(block.substr(0, 200)), "the end of the text") ||
          names(refusal(block.substr(0, 200)), "a number"));
    CHECK(names(refusal(""), "the end of the text"));
}

TEST("no beginning of the text is a vehicle") {
    for (std::size_t length = 0; length + 1 < block.size(); ++length)
        CHECK(!refusal(block.substr(0, length)).empty());
}
