#include <algorithm>
#include <array>
#include <map>

#include "birm3d/model/truss_mesh.hpp"

namespace birm3d {

// All trusses of a node spring back together: by the most that any of them does.
void TrussMesh::find_springback(const TrussInput& input) {
    std::map<std::array<double, 3>, double> most;
    const auto place = [&](std::size_t source) {
        return std::array{input.node[source].x(), input.node[source].y(), input.node[source].z()};
    };
    for (std::size_t source = 0; source < count; ++source) {
        const double of_truss = input.curve[input.curve_of[source]].springback;
        if (of_truss > 0.0) most[place(source)] = std::max(most[place(source)], of_truss);
    }
    if (most.empty()) return;
    springback.fill().resize(blocks);
    for (std::size_t b = 0; b < blocks; ++b)
        for (std::size_t i = 0; i < nodes_in(b); ++i)
            if (const auto found = most.find(place(input_index[first[b] + i])); found != most.end())
                springback.fill()[b][i] = found->second;
}

}  // namespace birm3d
