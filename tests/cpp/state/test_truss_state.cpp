#include "birm3d/state/truss_state.hpp"

#include "check.hpp"
#include "laboratory.hpp"

using namespace birm3d;

TEST("a skin that is reset is as it was made") {
    const TrussMesh mesh(laboratory::front_face(laboratory::w2_curve(), 8, 8));
    TrussState state(mesh);
    TrussBlockState& block = state.block[0];
    block.touching = block.slack = block.met = block.hangs = true;
    block.lagging.set(3);
    for (BlockColumn* column : {&block.x, &block.deflection, &block.force, &block.peak_deflection,
                                &block.residual, &block.unloading})
        (*column)[0] += 1.0;
    state.reset(mesh);
    CHECK(!block.touching);
    CHECK(!block.slack);
    CHECK(!block.met);
    CHECK(!block.hangs);
    CHECK(!block.may_lag());
    CHECK(!state.groups[0].hangs);
    Hash as_made, again;
    TrussState(mesh).add_to(as_made);
    state.add_to(again);
    CHECK(as_made.value() == again.value());
    CHECK(block.unloading[0] == mesh.block[0].k_unloading[0]);
}
