// Every block of a group called at random, on arms of several kinds. The rig asserts in every cycle that the members are told one motion within their
// limits, and that it is what is shown; here: every block's outputs are those of its lifecycle, the states are those of the diagram, what is shown of the
// tool is where the members are, and nothing hangs.

#include <gtest/gtest.h>

#include <tuple>

#include "tests/axes/group/by_hand.hpp"
#include "tests/fb_library/groups/group_plc.hpp"
#include "tests/fb_library/groups/group_walk.hpp"
#include "tests/property_cases.hpp"

namespace taktwerk::fb {
namespace {

using namespace axes::test;  // NOLINT(google-build-using-namespace): the rig's
using enum axes::GroupState;

template <class... Blocks>
using Blocks2 = std::tuple<Blocks..., Blocks...>;

/// Twice each, so that one is busy while the other one comes.
using Moves = Blocks2<MC_MoveLinearAbsolute, MC_MoveLinearRelative, MC_MoveCircularAbsolute, MC_MoveCircularRelative, MC_MoveDirectAbsolute,
                      MC_MoveDirectRelative, MC_GroupWaitTime>;
using Tracks = Blocks2<MC_TrackConveyorBelt, MC_TrackRotaryTable>;
using Stops = std::tuple<MC_GroupHalt, MC_GroupInterrupt, MC_GroupContinue, MC_GroupStop>;
using Settings =
    std::tuple<MC_SetCartesianTransform, MC_SetCoordinateTransform, MC_GroupWriteToolData, MC_GroupSelectTool, MC_GroupWritePayloadData,
               MC_GroupSelectPayload, MC_GroupWriteRigidBodyDynamic, MC_GroupWriteDefaultDynamics, MC_GroupWriteReferenceDynamics,
               MC_GroupWriteJoggingDynamics, MC_GroupWriteParameter, MC_GroupWriteSWLimits, MC_GroupSetPosition>;
using Seldom = std::tuple<MC_GroupHome, MC_GroupDisable, MC_GroupEnable, MC_GroupReset, MC_UngroupAllAxes, MC_RemoveAxisFromGroup>;
using Reads = std::tuple<MC_GroupReadStatus, MC_GroupReadMotionState, MC_GroupReadError, MC_GroupReadCommandInfo, MC_GroupReadConfiguration,
                         MC_GroupReadPosition, MC_GroupReadVelocity, MC_GroupReadAcceleration, MC_GroupReadActualPosition,
                         MC_GroupReadActualVelocity, MC_ReadCartesianTransform, MC_ReadCoordinateTransform, MC_ReadKinTransform,
                         MC_ReadDHParameters, MC_ReadJointInfo, MC_GroupTransformPosition, MC_GroupReadToolData, MC_GroupReadTool,
                         MC_GroupReadPayloadData, MC_GroupReadPayload, MC_GroupReadRigidBodyDynamic, MC_GroupReadDefaultDynamics,
                         MC_GroupReadReferenceDynamics, MC_GroupReadJoggingDynamics, MC_GroupReadSWLimits, MC_GroupReadParameter>;

class BlockWalk {
public:
    BlockWalk(std::uint64_t seed, const JogArm& arm)
        : draws_(seed),
          arm_(arm),
          kinematics_(arm_of(arm.description)),
          plc_(with_masters(axes_of(arm)), GroupRig::all_of(axes_of(arm), kinematics_)) {
        draws_.member_count = arm.turning.size();
        const auto first = static_cast<std::uint16_t>(draws_.member_count);
        draws_.belt = {first};
        draws_.table = {static_cast<std::uint16_t>(first + 1)};
        sync_.SlaveAxis = {static_cast<std::uint16_t>(first + 2)};
    }
    /// What moves frames, and what follows the path.
    static std::vector<axes::AxisConfig> with_masters(std::vector<axes::AxisConfig> all) {
        for (const auto* name : {"belt", "table", "pump"})
            all.push_back(group_axis(name, {.velocity = 100, .acceleration = 250, .deceleration = 250, .jerk = 1000}));
        all[all.size() - 2].modulo = 360;
        return all;
    }

    void run(int scans) {
        begin();
        plc_.program = [this](const MotionContext& ctx) { scan(ctx); };
        for (int i = 0; i < scans && !::testing::Test::HasFailure(); ++i) {
            plc_.scan();
            look();
        }
        if (::testing::Test::HasFailure()) ADD_FAILURE() << arm_.name << ", in the end: " << said_;
    }
    [[nodiscard]] int done() const { return done_; }
    /// Scans in which it was on a belt or a table.
    [[nodiscard]] int tracked() const { return tracked_; }

private:
    GroupRig& rig() { return plc_.rig; }
    const axes::GroupView& view() { return rig().view(); }

    void begin() {
        for (auto& axis : rig().axes) (void)axis.submit({.kind = axes::CommandKind::home, .position = 0}, axes::Owner::program);
        rig().run(50);
        rig().enable();
        ASSERT_EQ(rig().set(axes::WriteJoggingDynamics{jogging_of_arms()}), axes::ErrorId::none);
        const auto there = rig().give({.kind = axes::GroupCommandKind::direct_absolute, .target = arm_.start});
        ASSERT_TRUE(rig().until([&] { return rig().status(there.id) == axes::CommandStatus::done; }, 5000));
        rig().run(3);
    }

    template <class Tuple>
    void call(Tuple& blocks, std::array<ExecuteLife, std::tuple_size_v<Tuple>>& lives, const MotionContext& ctx, double often) {
        std::size_t i = 0;
        std::apply([&](auto&... b) { (call_one(b, lives[i++], ctx, often / sizeof...(b)), ...); }, blocks);
    }
    template <class Block>
    void call_one(Block& b, ExecuteLife& life, const MotionContext& ctx, double often) {
        b.AxesGroup = GroupPlc::group;
        if (!b.Execute && draws_.chance(often)) {
            draw(b, draws_);
            if constexpr (requires { b.Position.C; }) near_the_tool(b);
            b.Execute = true;
            said_ += std::to_string(ctx.cycle) + " " + name_of<Block>() + "; ";
            if (said_.size() > 1500) said_.erase(0, 500);
        } else if (b.Execute && draws_.chance(b.Busy ? 0.002 : 0.05)) {
            b.Execute = false;
        }
        const bool was = b.Done;
        b(ctx);
        if (b.Done && !was) ++done_;
        const auto wrong = life.look(b);
        EXPECT_TRUE(wrong.empty()) << name_of<Block>() << ": " << wrong;
        busy_ = busy_ || b.Busy;
    }
    /// In a product's frame often a place that is not far, wherever the product is by now.
    template <class Block>
    void near_the_tool(Block& b) {
        if (!axes::is_product(b.CoordSystem) || draws_.chance(0.3)) return;
        auto six = rig().groups.position_in(GroupRig::ref, b.CoordSystem, mcSetValue).place.six;
        for (std::size_t i = 0; i < 3; ++i) six[i] += draws_.uniform(-10, 10);
        b.Position.C.Tcp = {six[0], six[1], six[2], six[3], six[4], six[5]};
    }
    template <class Block>
    static std::string name_of() {
        const std::string all = __PRETTY_FUNCTION__;
        const auto at = all.rfind("MC_");
        return all.substr(at, all.find_first_of(";]", at) - at);
    }

    void scan(const MotionContext& ctx) {
        for (std::size_t i = 0; i < draws_.member_count; ++i) draws_.members[i] = view().set_position[i];
        if (view().tool_known) draws_.tool = view().tool_set;
        if (draws_.chance(0.0005)) pace_ = std::exp(draws_.uniform(std::log(0.002), std::log(0.2)));
        draws_.tool_seen = hand_six(hand_frame(rig().groups.equipment(GroupRig::ref)->frames.machine) * hand_frame(draws_.tool));
        masters();
        couple(ctx);
        busy_ = false;
        call(moves_, move_lives_, ctx, pace_);
        call(tracks_, track_lives_, ctx, pace_ / 2);
        call(stops_, stop_lives_, ctx, pace_ / 6);
        call(settings_, setting_lives_, ctx, pace_ / 2);
        call(seldom_, seldom_lives_, ctx, pace_ / 80);
        jog(jog_, ctx);
        jog(vector_, ctx);
        factors(ctx);
        std::apply([&](auto&... b) { (read(b, ctx), ...); }, reads_);
        fault(ctx);
        recover();
    }
    void masters() {
        for (const auto master : {draws_.belt, draws_.table}) {
            if (!draws_.chance(0.003)) continue;
            auto& axis = rig().axes[master.index];
            const double v = draws_.chance(0.3) ? 0 : draws_.uniform(-30, 30);
            (void)axis.submit(v == 0 ? axes::AxisCommand{.kind = axes::CommandKind::halt}
                                     : axes::AxisCommand{.kind = axes::CommandKind::move_velocity, .velocity = v},
                              axes::Owner::program);
            if (draws_.chance(0.1))
                (void)axis.set(axes::SetPosition{.position = draws_.uniform(-90, 90), .relative = true}, axes::Owner::program);
        }
    }
    /// It goes on until the slave gets something else to do: no Done.
    void couple(const MotionContext& ctx) {
        if (draws_.chance(0.002)) {
            sync_.Execute = !sync_.Execute;
            sync_.RatioNumerator = static_cast<std::int16_t>(draws_.whole(-3, 3));
            sync_.RatioDenominator = static_cast<std::uint16_t>(draws_.whole(0, 4));
            sync_.Acceleration = draws_.ramp();
        }
        if (draws_.chance(0.0005)) (void)rig().axes[sync_.SlaveAxis.index].submit({.kind = axes::CommandKind::halt}, axes::Owner::program);
        sync_.AxesGroup = GroupPlc::group;
        sync_(ctx);
        const int shown = static_cast<int>(sync_.Busy) + static_cast<int>(sync_.CommandAborted) + static_cast<int>(sync_.Error);
        EXPECT_TRUE(sync_.Execute ? shown == 1 : shown <= 1) << "MC_SyncAxisToGroup";
        EXPECT_EQ(sync_.Error, sync_.ErrorID != ErrorId::none);
        EXPECT_TRUE(sync_.Busy || !sync_.Active);
        EXPECT_TRUE(sync_.Active || !sync_.InSync);
    }
    template <class Block>
    void jog(Block& b, const MotionContext& ctx) {
        b.AxesGroup = GroupPlc::group;
        if (draws_.chance(b.Enable ? 0.004 : pace_ / 100)) {
            b.Enable = !b.Enable;
            b.CoordSystem = std::array{mcACS, mcMCS, mcPCS, mcTCS}[static_cast<std::size_t>(draws_.whole(0, 3))];
        }
        if (b.Enable && draws_.chance(0.01)) {
            b.VelOverride = draws_.number(-0.02, 1.02);
            if constexpr (requires { b.Direction; })
                for (double& part : b.Direction) part = draws_.chance(0.6) ? 0 : draws_.number(-1, 1);
            else
                for (std::size_t i = 0; i < b.JogPositive.size(); ++i) {
                    b.JogPositive[i] = i < 6 && draws_.chance(0.2);
                    b.JogNegative[i] = i < 6 && draws_.chance(0.2);
                }
        }
        b(ctx);
        const auto wrong = look_at_reading(b);
        EXPECT_TRUE(wrong.empty()) << name_of<Block>() << ": " << wrong;
    }
    template <class Block>
    void read(Block& b, const MotionContext& ctx) {
        b.AxesGroup = GroupPlc::group;
        if (draws_.chance(0.01)) {
            draw(b, draws_);
            b.Enable = !b.Enable;
        }
        b(ctx);
        const auto wrong = look_at_reading(b);
        EXPECT_TRUE(wrong.empty()) << name_of<Block>() << ": " << wrong;
    }
    void factors(const MotionContext& ctx) {
        override_.AxesGroup = GroupPlc::group;
        override_.Enable = true;
        if (draws_.chance(0.003)) override_.VelFactor = draws_.chance(0.15) ? 0 : draws_.number(0.1, 1);
        if (override_.VelFactor == 0 && draws_.chance(0.01)) override_.VelFactor = 1;
        override_(ctx);
    }
    void fault(const MotionContext& ctx) {
        if (draws_.chance(pace_ / 3000)) {
            rig().drives[static_cast<std::size_t>(draws_.whole(0, static_cast<int>(draws_.member_count) + 2))]->fault_code = 0x2310;
            healed_ = ctx.cycle + 200;
        }
        if (ctx.cycle >= healed_)
            for (auto& drive : rig().drives) drive->fault_code = 0;
    }
    /// The person at the machine.
    void recover() {
        if (!draws_.chance(0.02)) return;
        if (view().state == GroupErrorStop) (void)rig().groups.reset(GroupRig::ref, axes::Owner::program);
        for (std::size_t i = draws_.member_count; i < rig().axes.size(); ++i)
            if (rig().axis(i).state == axes::AxisState::ErrorStop) (void)rig().axes[i].reset(axes::Owner::program);
        for (std::size_t i = 0; i < draws_.member_count; ++i)
            if (view().state == GroupDisabled && !view().has(i))
                (void)rig().set(axes::AddMember{{static_cast<std::uint16_t>(i)}, static_cast<std::uint8_t>(i + 1)});
        if (view().state == GroupDisabled) (void)rig().set(axes::EnableGroup{});
        if (view().interrupted && draws_.chance(0.1)) (void)rig().submit({.kind = axes::GroupCommandKind::resume});
    }

    void look() {
        const bool leads = rig().groups[0].leads();
        tracked_ += view().track.in_sync ? 1 : 0;
        const auto& v = view();
        if (v.state == GroupStandby || v.state == GroupDisabled || v.state == GroupHoming) {
            EXPECT_FALSE(leads);
        }
        if (v.state == GroupMoving) {
            EXPECT_TRUE(leads);
        }
        if (v.state == GroupStandby && !v.interrupted) {
            EXPECT_EQ(v.active, 0u);
            EXPECT_EQ(v.queued_count, 0u) << "waits for nothing";
        }
        bool stands = true;
        for (std::size_t i = 0; i < draws_.member_count; ++i) {
            const auto& axis = rig().axis(i);
            stands = stands && axis.set_velocity == 0;
            if (leads && axis.active_kind == axes::CommandKind::group_motion) {
                EXPECT_EQ(axis.state, axes::AxisState::SynchronizedMotion) << i;
            }
        }
        const bool may_stand =
            !busy_ || v.interrupted || override_.VelFactor < 1e-3 || v.state == GroupDisabled || v.state == GroupErrorStop;
        idle_ = stands && !may_stand ? idle_ + 1 : 0;
        EXPECT_LT(idle_, 2500) << "hangs in " << axes::name(v.state) << ", active " << v.active << " of kind "
                               << static_cast<int>(v.active_kind) << ", waiting " << static_cast<int>(v.queued_count);
        if (leads || !v.tool_known || v.interrupted) return;
        // Told = inside: the selected tool's point, in the machine and in a product.
        axes::Joints q{};
        for (std::size_t i = 0; i < draws_.member_count; ++i) q[i] = v.set_position[i];
        const auto& equipment = *rig().groups.equipment(GroupRig::ref);
        const auto at = kinematics_->forward(q, equipment.tool_pose());
        ASSERT_TRUE(at.miss.ok());
        const auto point = hand_frame(axes::numbers_of(at.pose));
        EXPECT_LE(apart(hand_frame(v.tool_set), point), 1e-9 * 1000);
        const auto told = rig().groups.position_in(GroupRig::ref, mcPCS_3, mcSetValue);
        const auto product = back(hand_frame(equipment.frames.product[2])) * hand_frame(equipment.frames.machine) * point;
        EXPECT_LE(apart(hand_frame(told.place.six), product), 1e-9 * 1000);
    }

    PinDraws draws_;
    const JogArm& arm_;
    Arm kinematics_;
    GroupPlc plc_;
    Moves moves_;
    Tracks tracks_;
    MC_SyncAxisToGroup sync_;
    Stops stops_;
    Settings settings_;
    Seldom seldom_;
    Reads reads_;
    MC_GroupJog jog_;
    MC_GroupJogVector vector_;
    MC_GroupSetOverride override_;
    std::array<ExecuteLife, std::tuple_size_v<Moves>> move_lives_;
    std::array<ExecuteLife, std::tuple_size_v<Tracks>> track_lives_;
    std::array<ExecuteLife, std::tuple_size_v<Stops>> stop_lives_;
    std::array<ExecuteLife, std::tuple_size_v<Settings>> setting_lives_;
    std::array<ExecuteLife, std::tuple_size_v<Seldom>> seldom_lives_;
    std::string said_;
    std::uint64_t healed_ = 0;
    int done_ = 0, idle_ = 0, tracked_ = 0;
    double pace_ = 0.02;
    bool busy_ = false;
};

TEST(GroupWalk, EveryBlockAtRandomOnArmsOfSeveralKinds) {
    const auto arms = every_kind_of_arm();
    int done = 0, tracked = 0;
    for (std::size_t i = 0; i < property_cases(arms.size()) && !HasFailure(); ++i) {
        SCOPED_TRACE(::testing::Message() << "walk " << i << " of " << arms[i % arms.size()].name);
        BlockWalk walk(7700 + i, arms[i % arms.size()]);
        walk.run(6000);
        done += walk.done();
        tracked += walk.tracked();
    }
    EXPECT_GT(done, 300);
    EXPECT_GT(tracked, 1000);
}

}  // namespace
}  // namespace taktwerk::fb
