#include "birm3d/model/vehicle_text.hpp"

#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "birm3d/base/error.hpp"

namespace birm3d {

namespace {

// Value of a hexadecimal digit; none of another character.
std::optional<unsigned> digit_of(char c) {
    if (c >= '0' && c <= '9') return static_cast<unsigned>(c - '0');
    if (c >= 'a' && c <= 'f') return static_cast<unsigned>(c - 'a' + 10);
    return {};
}

std::optional<int> whole_number(std::string_view word) {
    int value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size()) return {};
    return value;
}

// Of [-]0x1.8p+3, which has at most fourteen digits: 53 bits are exact.
std::optional<double> hexadecimal(std::string_view word) {
    const bool negative = word.starts_with('-');
    if (negative) word.remove_prefix(1);
    const double sign = negative ? -1.0 : 1.0;
    if (word == "inf") return sign * infinity;
    if (!word.starts_with("0x")) return {};
    word.remove_prefix(2);
    const std::size_t power = word.find('p');
    if (power == std::string_view::npos) return {};
    std::uint64_t digits = 0;
    int exponent = 0, count = 0;
    bool after_point = false;
    for (const char c : word.substr(0, power)) {
        if (c == '.' && !after_point) {
            after_point = true;
            continue;
        }
        const auto digit = digit_of(c);
        if (!digit || ++count > 14) return {};
        digits = 16 * digits + *digit;
        if (after_point) exponent -= 4;
    }
    word.remove_prefix(power + 1);
    if (word.starts_with('+')) word.remove_prefix(1);
    const auto stated = whole_number(word);
    if (!stated || count == 0 || std::abs(*stated) > 2000) return {};
    return sign * std::ldexp(static_cast<double>(digits), exponent + *stated);
}

class Reader {
  public:
    explicit Reader(std::string_view text) : rest_(text) {}

    std::string_view word() {
        skip_space();
        const std::size_t end = rest_.find_first_of(" \t\r\n");
        const std::string_view found = rest_.substr(0, end);
        if (found.empty()) wrong("more", "the end of the text");
        rest_.remove_prefix(found.size());
        return found;
    }

    void expect(std::string_view name) {
        const std::string_view found = word();
        if (found != name) wrong("\"" + std::string(name) + "\"", quoted(found));
    }

    void expect_end() {
        expect("end");
        skip_space();
        if (!rest_.empty()) wrong("nothing after \"end\"", "more");
    }

    double number() {
        const std::string_view found = word();
        const auto value = hexadecimal(found);
        if (!value) wrong("a number as 0x1.8p+3", quoted(found));
        return *value;
    }
    double number(std::string_view name) {
        expect(name);
        return number();
    }

    int whole() {
        const std::string_view found = word();
        const auto value = whole_number(found);
        if (!value) wrong("a whole number", quoted(found));
        return *value;
    }
    std::size_t index() {
        const int value = whole();
        if (value < 0) wrong("a whole number >= 0", std::to_string(value));
        return static_cast<std::size_t>(value);
    }
    std::size_t count(std::string_view name) {
        expect(name);
        return index();
    }

    Vec3 vector() {
        const double x = number(), y = number(), z = number();
        return {x, y, z};
    }
    Vec3 vector(std::string_view name) {
        expect(name);
        return vector();
    }

    [[noreturn]] void wrong(const std::string& wanted, const std::string& found) const {
        refuse("line " + std::to_string(line_) + " of the vehicle", wanted, found);
    }

    static std::string quoted(std::string_view word) { return "\"" + std::string(word.substr(0, 40)) + "\""; }

  private:
    void skip_space() {
        while (!rest_.empty() && std::string_view(" \t\r\n").find(rest_.front()) != std::string_view::npos) {
            if (rest_.front() == '\n') ++line_;
            rest_.remove_prefix(1);
        }
    }

    std::string_view rest_;
    int line_ = 1;
};

std::vector<Wheel> wheels_of(Reader& in, std::string_view name) {
    std::vector<Wheel> wheels;
    for (std::size_t left = in.count(name); left > 0; --left) {
        const Vec3 center = in.vector();
        const double radius = in.number();
        const double breakaway = in.number(), travel = in.number();
        const double stiffness = in.number(), damping = in.number(), at_rest = in.number();
        const double bump = in.number(), roll_ratio = in.number(), steering_time = in.number(),
                     tread_radius = in.number();
        const double camber_ratio = in.number();
        wheels.push_back({center,
                          radius,
                          breakaway,
                          travel,
                          {stiffness, damping, at_rest, bump, roll_ratio},
                          steering_time,
                          tread_radius,
                          camber_ratio,
                          in.number()});
    }
    return wheels;
}

TrussCurve curve_of(Reader& in) {
    TrussCurve curve;
    std::size_t points = in.index();
    curve.k_unloading = in.number();
    curve.recovery = in.number();
    curve.friction_share = in.number();
    curve.springback = in.number();
    for (; points > 0; --points) {
        curve.deflection.push_back(in.number());
        curve.slope.push_back(in.number());
    }
    return curve;
}

TrussInput trusses_of(Reader& in) {
    TrussInput input;
    input.rate_sensitivity = in.number("rate_sensitivity");
    input.indentation_length = in.number("indentation_length");
    for (std::size_t left = in.count("curves"); left > 0; --left)
        input.curve.push_back(curve_of(in));
    for (std::size_t left = in.count("trusses"); left > 0; --left) {
        input.node.push_back(in.vector());
        input.anchor.push_back(in.vector());
        input.curve_of.push_back(in.index());
        input.scale.push_back(in.number());
        input.wheel_of.push_back(in.whole());
        input.along_of.push_back(in.whole());
    }
    return input;
}

Unit unit_of(Reader& in) {
    const double mass = in.number("mass");
    in.expect("inertia");
    Mat3 inertia;
    for (int i = 0; i < 3; ++i)
        inertia.row(i) = in.vector().transpose();
    const RigidBody body(mass, inertia);
    const double height = in.number("mass_center_height");
    const Vec3 offset = in.vector("offset");
    std::vector<Wheel> wheels = wheels_of(in, "wheels");
    std::vector<Box> boxes;
    for (std::size_t left = in.count("boxes"); left > 0; --left) {
        const Vec3 center = in.vector();
        boxes.push_back({center, in.vector()});
    }
    const Vec3 origin = in.vector("mesh_origin");
    const std::vector<Wheel> mesh_wheels = wheels_of(in, "mesh_wheels");
    const TrussMesh mesh(trusses_of(in), mesh_wheels);
    return {body, mesh.moved(origin), std::move(wheels), height, offset, std::move(boxes)};
}

Joint joint_of(Reader& in) {
    Joint joint;
    const std::string_view kind = in.word();
    if (kind == "welded")
        joint.kind = JointKind::welded;
    else if (kind == "sliding")
        joint.kind = JointKind::sliding;
    else if (kind != "fifth_wheel")
        in.wrong("fifth_wheel, welded or sliding", Reader::quoted(kind));
    joint.leading = in.index();
    joint.trailing = in.index();
    joint.place_on_leading = in.vector();
    joint.place_on_trailing = in.vector();
    joint.roll_limit = in.number();
    if (joint.kind != JointKind::sliding) return joint;
    for (std::size_t left = in.count("slide"); left > 0; --left) {
        const double slip = in.number();
        joint.slide.push_back({slip, in.number()});
    }
    return joint;
}

}  // namespace

Vehicle vehicle_of_text(std::string_view text) {
    Reader in(text);
    in.expect("birm3d-vehicle");
    if (const int version = in.whole(); version != 8)
        in.wrong("version 8", "version " + std::to_string(version));
    in.expect("cornering_stiffness");
    const double cornering_stiffness = in.number();
    in.expect("edge_flank_factor");
    const double edge_flank_factor = in.number();
    std::vector<Unit> units;
    for (std::size_t left = in.count("units"); left > 0; --left)
        units.push_back(unit_of(in));
    std::vector<Joint> joints;
    for (std::size_t left = in.count("joints"); left > 0; --left)
        joints.push_back(joint_of(in));
    in.expect_end();
    Vehicle vehicle = joined(std::move(units), std::move(joints));
    vehicle.cornering_stiffness = cornering_stiffness;
    vehicle.edge_flank_factor = edge_flank_factor;
    require_valid(usual_settings(vehicle, nullptr));
    return vehicle;
}

}  // namespace birm3d
