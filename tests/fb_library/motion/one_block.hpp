#pragma once
// One block on axes played by hand.
#include <gtest/gtest.h>

#include "fb_library/all_blocks.hpp"
#include "tests/fb_library/fake_axes.hpp"

namespace taktwerk::fb {

template <class Block>
struct OneBlock : testing::Test {
    void scan() {
        axes.next_scan();
        block(axes.context);
    }
    /// The block's command begins.
    void begin() {
        block.Execute = true;
        scan();
        scan();
    }
    const FakeAxes::Call& last() const { return axes.calls.back(); }
    template <class Details>
    const Details& details() const {
        return std::get<Details>(last().command.details);
    }

    FakeAxes axes{3};
    Block block{};
};

}  // namespace taktwerk::fb
