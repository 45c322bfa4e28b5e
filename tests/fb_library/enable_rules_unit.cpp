// Settings with an ExecutionMode and blocks with an Enable, over every such block of the list: PLCopen Part 1 v2.0, 2.4.1.

#include "tests/fb_library/block_rules.hpp"

namespace taktwerk::fb {
namespace {

// --- settings: ExecutionMode ---------------------------------------------------------------------------------------------

class SettingRules : public Bench {};
INSTANTIATE_TEST_SUITE_P(Each, SettingRules, testing::ValuesIn(setting_blocks()), name_of);

TEST_P(SettingRules, QueuedItWaitsForItsTurnLikeABufferedCommand) {  // P1-201, P1-215
    axes.take_over();                                                // a motion runs
    block.ExecutionMode = mcQueued;
    begin();
    ASSERT_EQ(axes.calls.size(), 1u);
    const auto& submitted = axes.calls[0];
    EXPECT_EQ(submitted.what, "submit");
    EXPECT_EQ(submitted.command.kind, axes::CommandKind::setting);
    EXPECT_EQ(submitted.command.buffer_mode, mcBuffered);
    scan();
    EXPECT_TRUE(block.Busy);
    EXPECT_FALSE(done());
    axes.finish(axes::Outcome::done);  // the motion
    scan();
    EXPECT_TRUE(block.Busy) << "it is its turn, but it is not over";
    EXPECT_FALSE(done());
    axes.finish(axes::Outcome::done);  // the setting
    if (has("CamTableID"))
        for (std::size_t i = 0; i < 2; ++i)
            axes.axis(i).selected_as = reinterpret_cast<const MC_CamTableSelect*>(block.bytes())->wanted;  // as an axis shows it then
    scan();
    EXPECT_TRUE(done());
    EXPECT_FALSE(block.Busy);
    EXPECT_FALSE(block.Error);
    EXPECT_EQ(axes.calls.size(), 1u) << "asked for once";
}

TEST_P(SettingRules, ClearedFromTheQueueItIsAnError) {  // no CommandAborted pin
    axes.take_over();
    block.ExecutionMode = mcQueued;
    begin();
    axes.last_slot.reset();
    axes.take_over();  // an aborting command clears the queue
    scan();
    EXPECT_EQ(block.ErrorID, ErrorId::aborted_by_command);
}

// --- blocks with an Enable -----------------------------------------------------------------------------------------------

class EnableRules : public Bench {};
INSTANTIATE_TEST_SUITE_P(Each, EnableRules, testing::ValuesIn(enable_blocks()), name_of);

TEST_P(EnableRules, InvalidAxisIsAnErrorThatGoesWhenTheHandleIsMended) {  // P1-049
    if (!names_an_axis()) return;
    aim(0xFFFF);
    block.Enable = true;
    scan();
    EXPECT_TRUE(block.Error);
    EXPECT_EQ(block.ErrorID, ErrorId::invalid_axis);
    EXPECT_FALSE(valid());
    if (has("Busy")) {
        EXPECT_TRUE(block.Busy);
        aim(0);
        scan();
        EXPECT_TRUE(valid());
        EXPECT_FALSE(block.Error);
        EXPECT_EQ(block.ErrorID, ErrorId::none);
    }
}

TEST_P(EnableRules, EveryOutputGoesBackInTheCallInWhichEnableFalls) {  // P1-065
    AnyBlock fresh{*kind.type};
    block.Enable = true;
    axes.axis().actual_position = 3;
    scan();
    EXPECT_TRUE(valid());

    block.Enable = false;
    scan();
    for (const Pin& pin : kind.type->pins) {
        if (pin.direction != PinDirection::out || pin.name == "Status") continue;  // MC_Power.Status is the power stage's
        EXPECT_EQ(std::memcmp(block.bytes() + pin.offset, fresh.bytes() + pin.offset, pin.size), 0) << pin.name;
    }
}

TEST_P(EnableRules, ErrorOutputsFallWithEnable) {  // P1-048
    aim(0xFFFF);
    block.Enable = true;
    scan();
    block.Enable = false;
    scan();
    EXPECT_FALSE(block.Error);
    EXPECT_EQ(block.ErrorID, ErrorId::none);
}

}  // namespace
}  // namespace taktwerk::fb
