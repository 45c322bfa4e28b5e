// Settings with an ExecutionMode and blocks with an Enable, over every such block of the list: PLCopen Part 1 v2.0, 2.4.1.

#include "tests/fb_library/block_rules.hpp"

namespace taktwerk::fb {
namespace {

// --- settings: ExecutionMode ---------------------------------------------------------------------------------------------

template <class B>
class SettingRules : public Bench<B> {};
TYPED_TEST_SUITE(SettingRules, SettingBlocks);

TYPED_TEST(SettingRules, QueuedItWaitsForItsTurnLikeABufferedCommand) {  // P1-201, P1-215
    this->axes.take_over();                                              // a motion runs
    this->block.ExecutionMode = mcQueued;
    this->begin();
    ASSERT_EQ(this->axes.calls.size(), 1u);
    const auto& submitted = this->axes.calls[0];
    EXPECT_EQ(submitted.what, "submit");
    EXPECT_EQ(submitted.command.kind, axes::CommandKind::setting);
    EXPECT_EQ(submitted.command.buffer_mode, mcBuffered);
    this->scan();
    EXPECT_TRUE(this->block.Busy);
    EXPECT_FALSE(this->done());
    this->axes.finish(axes::Outcome::done);  // the motion
    this->scan();
    EXPECT_TRUE(this->block.Busy) << "it is its turn, but it is not over";
    EXPECT_FALSE(this->done());
    this->axes.finish(axes::Outcome::done);  // the setting
    if constexpr (requires { this->block.CamTableID; })
        for (std::size_t i = 0; i < 2; ++i) this->axes.axis(i).selected_as = this->block.wanted;  // as an axis shows it then
    this->scan();
    EXPECT_TRUE(this->done());
    EXPECT_FALSE(this->block.Busy);
    EXPECT_FALSE(this->block.Error);
    EXPECT_EQ(this->axes.calls.size(), 1u) << "asked for once";
}

TYPED_TEST(SettingRules, ClearedFromTheQueueItIsAnError) {  // no CommandAborted pin
    this->axes.take_over();
    this->block.ExecutionMode = mcQueued;
    this->begin();
    this->axes.last_slot.reset();
    this->axes.take_over();  // an aborting command clears the queue
    this->scan();
    EXPECT_EQ(this->block.ErrorID, ErrorId::aborted_by_command);
}

// --- blocks with an Enable -----------------------------------------------------------------------------------------------

template <class B>
class EnableRules : public Bench<B> {};
TYPED_TEST_SUITE(EnableRules, EnableBlocks);

TYPED_TEST(EnableRules, InvalidAxisIsAnErrorThatGoesWhenTheHandleIsMended) {  // P1-049
    if (!this->names_an_axis) return;
    this->aim(0xFFFF);
    this->block.Enable = true;
    this->scan();
    EXPECT_TRUE(this->block.Error);
    EXPECT_EQ(this->block.ErrorID, ErrorId::invalid_axis);
    EXPECT_FALSE(this->valid());
    if constexpr (requires { this->block.Busy; }) {
        EXPECT_TRUE(this->block.Busy);
        this->aim(0);
        this->scan();
        EXPECT_TRUE(this->valid());
        EXPECT_FALSE(this->block.Error);
        EXPECT_EQ(this->block.ErrorID, ErrorId::none);
    }
}

TYPED_TEST(EnableRules, EveryOutputGoesBackInTheCallInWhichEnableFalls) {  // P1-065
    const TypeParam fresh{};
    this->block.Enable = true;
    this->axes.axis().actual_position = 3;
    this->scan();
    EXPECT_TRUE(this->valid());

    this->block.Enable = false;
    this->scan();
    for (const Pin& pin : pins_of<TypeParam>) {
        if (pin.direction != PinDirection::out || pin.name == "Status") continue;  // MC_Power.Status is the power stage's
        EXPECT_EQ(std::memcmp(reinterpret_cast<const char*>(&this->block) + pin.offset, reinterpret_cast<const char*>(&fresh) + pin.offset,
                              pin.size),
                  0)
            << pin.name;
    }
}

TYPED_TEST(EnableRules, ErrorOutputsFallWithEnable) {  // P1-048
    this->aim(0xFFFF);
    this->block.Enable = true;
    this->scan();
    this->block.Enable = false;
    this->scan();
    EXPECT_FALSE(this->block.Error);
    EXPECT_EQ(this->block.ErrorID, ErrorId::none);
}

}  // namespace
}  // namespace taktwerk::fb
