#include "birm3d/kernels/dent.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace birm3d {

namespace {

// Cosine above which two trusses belong to one panel.
constexpr double same_panel = 0.9;

// Deflections and heights that differ by less are the same (m): rounding of places a few metres away is 1e-15.
constexpr double alike = 1e-11;

struct alignas(64) Directions {
    Lanes x, y, z;
};

BIRM3D_LANE_LOOP void directions_of(const TrussBlock& truss, Directions& to) {
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < lanes; ++i) {
        const double per = 1.0 / truss.length[i];
        to.x[i] = (truss.node_x[i] - truss.anchor_x[i]) * per;
        to.y[i] = (truss.node_y[i] - truss.anchor_y[i]) * per;
        to.z[i] = (truss.node_z[i] - truss.anchor_z[i]) * per;
    }
}

struct Driver {
    double x, y, z, bx, by, bz, deflection, number;
};

// How many nodes would the driver draw in further?
BIRM3D_LANE_LOOP double count_drawn(const TrussBlock& truss, const Directions& b, double per_slope,
                                    const Driver& d, const Lanes& deflection) {
    alignas(64) Lanes count;
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < lanes; ++i) {
        const double x = truss.node_x[i] - d.x, y = truss.node_y[i] - d.y, z = truss.node_z[i] - d.z;
        const double along = b.x[i] * d.bx + b.y[i] * d.by + b.z[i] * d.bz;
        const double reach = (d.deflection - deflection[i] + alike) * per_slope;
        count[i] = along > same_panel && reach > 0.0 && x * x + y * y + z * z < reach * reach ? 1.0 : 0.0;
    }
    return lane_sum(count);
}

// Hangs nodes on the driver; returns the least deflection that any of the block hangs to.
// What the nodes of a block hang on so far.
struct alignas(64) Chosen {
    Lanes deflection;      // m
    Lanes number, second;  // of the drivers; below zero: none
    Lanes height;          // of the first driver (m)
};

// Hangs nodes on the driver; returns the least deflection that any of the block hangs to. Drivers that draw a node in
// alike are told apart by their height, or share it: which of them comes first would else turn the vehicle.
BIRM3D_LANE_LOOP double hang_on(const TrussBlock& truss, const Directions& b, double slope, const Driver& d,
                                Chosen& chosen) {
    alignas(64) Lanes least;
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < lanes; ++i) {
        const double x = truss.node_x[i] - d.x, y = truss.node_y[i] - d.y, z = truss.node_z[i] - d.z;
        const double along = b.x[i] * d.bx + b.y[i] * d.by + b.z[i] * d.bz;
        const double drawn = d.deflection - slope * std::sqrt(x * x + y * y + z * z);
        const double more = drawn - chosen.deflection[i], higher = d.z - chosen.height[i];
        const bool same_way = along > same_panel && drawn > 0.0;
        const bool tie = more <= alike && more >= -alike;
        const bool first = same_way && (more > alike || (tie && higher < -alike));
        const bool shares = same_way && tie && higher <= alike && higher >= -alike;
        chosen.second[i] = first ? -1.0 : (shares ? d.number : chosen.second[i]);
        chosen.number[i] = first ? d.number : chosen.number[i];
        chosen.height[i] = first ? d.z : chosen.height[i];
        chosen.deflection[i] = first && more > 0.0 ? drawn : chosen.deflection[i];
        least[i] = chosen.deflection[i];
    }
    for (std::size_t half = lanes / 2; half > 0; half /= 2) {
        BIRM3D_INDEPENDENT
        for (std::size_t i = 0; i < half; ++i)
            least[i] = least[half + i] < least[i] ? least[half + i] : least[i];
    }
    return least[0];
}

}  // namespace

std::vector<DentGroup> grouped(std::span<const DentDriver> drivers) {
    constexpr std::size_t size = 16;
    std::vector<DentGroup> groups;
    for (std::size_t first = 0; first < drivers.size(); first += size) {
        DentGroup group{first, std::min(first + size, drivers.size()), {}, 0.0};
        group.box = Box::around(group.last - first, [&](std::size_t i) { return drivers[first + i].place; });
        for (std::size_t k = first; k < group.last; ++k)
            group.deepest = std::max(group.deepest, drivers[k].deflection);
        groups.push_back(group);
    }
    return groups;
}

void hang(const TrussBlock& trusses, const Box& box, double slope, std::span<const DentDriver> drivers,
          std::span<const DentGroup> groups, Hanging& hanging) {
    alignas(64) Directions directions;
    directions_of(trusses, directions);
    alignas(64) Chosen chosen;
    for (Lanes* column : {&chosen.deflection, &chosen.number, &chosen.second})
        column->fill(-1.0);
    chosen.height.fill(0.0);
    // Groups that may draw in furthest come first: what they leave to the others is soon seen.
    std::vector<std::pair<double, std::size_t>> order;  // most that a group can draw in, its place
    const auto most = [&](double deflection, const Box& around) {
        return deflection -
               slope *
                   ((around.center - box.center).cwiseAbs() - box.half - around.half).cwiseMax(0.0).norm();
    };
    for (std::size_t g = 0; g < groups.size(); ++g) {
        const double drawn = most(groups[g].deepest, groups[g].box);
        if (drawn > 0.0) order.emplace_back(-drawn, g);
    }
    std::sort(order.begin(), order.end());
    double least = 0.0;
    for (const auto& [minus_drawn, g] : order) {
        if (-minus_drawn < least - alike) break;
        for (std::size_t k = groups[g].first; k < groups[g].last; ++k) {
            const DentDriver& d = drivers[k];
            if (most(d.deflection, {d.place, Vec3::Zero()}) < least - alike) continue;
            const Driver driver{d.place.x(),     d.place.y(),     d.place.z(),  d.direction.x(),
                                d.direction.y(), d.direction.z(), d.deflection, static_cast<double>(k)};
            if (count_drawn(trusses, directions, 1.0 / slope, driver, chosen.deflection) == 0.0) continue;
            least = std::max(0.0, hang_on(trusses, directions, slope, driver, chosen));
        }
    }
    hanging.deflection = chosen.deflection;
    for (std::size_t i = 0; i < lanes; ++i) {
        hanging.driver[i] = static_cast<std::size_t>(std::max(chosen.number[i], 0.0));
        hanging.second[i] =
            chosen.second[i] < 0.0 ? hanging.driver[i] : static_cast<std::size_t>(chosen.second[i]);
    }
}

}  // namespace birm3d
