// The list of all blocks: pin tables against the standards, blocks as bytes, the ABI hash and the reference page.
#include "fb_library/all_blocks.hpp"
#include "fb_library/block_types.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <map>
#include <new>
#include <string>
#include <vector>

#include "fb_library/block_reference.hpp"
#include "tests/fb_library/fake_axes.hpp"
#include "tests/fb_library/part1_pins.hpp"

namespace taktwerk::fb {
namespace {

using testing::HasSubstr;

PinDirection direction_of(part1::Kind kind) {
    return kind == part1::VAR_INPUT ? PinDirection::in : kind == part1::VAR_OUTPUT ? PinDirection::out : PinDirection::in_out;
}

/// REAL is LREAL everywhere; an integer may be wider, WORD may be an unsigned word.
bool same_type(std::string_view standard, std::string_view ours) {
    if (standard == "REAL") return ours == "LREAL";
    if (standard == "INT") return ours == "INT" || ours == "DINT";
    if (standard == "UINT") return ours == "UINT" || ours == "UDINT";
    return standard == ours || (standard == "WORD" && ours == "UINT");
}

std::map<std::string, std::vector<part1::StandardPin>> standard_blocks() {
    std::map<std::string, std::vector<part1::StandardPin>> blocks;
    for (const auto& pin : part1::pins) blocks[std::string{pin.block}].push_back(pin);
    return blocks;
}

// P1-001, P1-002, P1-003, P1-004, P1-013, P1-098
TEST(PinTables, HaveEveryPinOfPart1InItsOrderAndNoOther) {
    const auto standard = standard_blocks();
    for (const BlockType& type : motion_block_types()) {
        const auto found = standard.find(std::string{type.name});
        if (found == standard.end()) continue;  // not of Part 1
        const auto& expected = found->second;
        ASSERT_EQ(type.pins.size(), expected.size()) << type.name;
        for (std::size_t i = 0; i < expected.size(); ++i) {
            EXPECT_EQ(type.pins[i].name, expected[i].name) << type.name;
            EXPECT_EQ(type.pins[i].direction, direction_of(expected[i].kind)) << type.name << '.' << expected[i].name;
            EXPECT_TRUE(same_type(expected[i].type, type.pins[i].type.name))
                << type.name << '.' << expected[i].name << ' ' << type.pins[i].type.name;
        }
    }
}

std::string pin_names(const BlockType& type) {
    std::string names;
    for (const Pin& pin : type.pins)
        names += (names.empty() ? "" : pin.direction != (&pin)[-1].direction ? " | " : " ") + std::string{pin.name};
    return names;
}

// Pins of motion blocks that are not of Part 1, after the documents they come from: axis first, as in PLCopen's tables.
const std::map<std::string, std::string>& other_documents() {
    static const std::map<std::string, std::string> documents{
        // TwinCAT Tc2_MC2
        {"MC_Jog",
         "Axis | JogForward JogBackwards Mode Position Velocity Acceleration Deceleration Jerk | "
         "Done Busy Active CommandAborted Error ErrorID"},
        // As there, without Options.
        {"MC_MoveModulo",
         "Axis | Execute Position Velocity Acceleration Deceleration Jerk Direction BufferMode | "
         "Done Busy Active CommandAborted Error ErrorID"},
        // our own, in the form of Part 1's MC_HaltSuperimposed
        {"MC_HaltPhasing", "Slave | Execute Deceleration Jerk | Done Busy CommandAborted Error ErrorID"},
        // our own, in the form of Part 1's MC_ReadActualPosition
        {"MC_ReadCommandPosition", "Axis | Enable | Valid Busy Error ErrorID Position"},
        {"MC_ReadCommandVelocity", "Axis | Enable | Valid Busy Error ErrorID Velocity"},
        {"MC_ReadCommandAcceleration", "Axis | Enable | Valid Busy Error ErrorID Acceleration"},
        // As there, without the target window; Enabled follows the axis, so there is no Done. Feed is a function there.
        {"MC_ExtSetPointGenEnable", "Axis | Execute | Enabled Busy Active CommandAborted Error ErrorID"},
        {"MC_ExtSetPointGenFeed", "Axis | Enable Position Velocity Acceleration | Valid Busy Error ErrorID"},
        {"MC_ExtSetPointGenDisable", "Axis | Execute Deceleration Jerk | Done Busy Active CommandAborted Error ErrorID"},
        // our own; a brake is no motion, so nobody takes over
        {"MC_SetBrake", "Axis | Execute Release | Done Busy Error ErrorID Released"},
        // RTmotion
        {"MC_SetControllerMode", "Axis | Execute Mode | Done Busy Active CommandAborted Error ErrorID"},
        // of vendors under this name; 60E0h and 60E1h, or 6072h, of CiA 402
        {"MC_SetTorqueLimit", "Axis | Execute PositiveLimit NegativeLimit | Done Busy Active CommandAborted Error ErrorID"},
        // our own, in the form of MC_MoveAbsolute, MC_MoveRelative, MC_MoveVelocity and MC_TorqueControl, with what a drive's profile has of them
        {"Drive_MoveAbsolute",
         "Axis | Execute Position Velocity Acceleration Deceleration Direction BufferMode | "
         "Done Busy Active CommandAborted Error ErrorID"},
        {"Drive_MoveRelative",
         "Axis | Execute Distance Velocity Acceleration Deceleration BufferMode | Done Busy Active CommandAborted Error ErrorID"},
        {"Drive_MoveVelocity",
         "Axis | Execute Velocity Acceleration Deceleration Direction BufferMode | InVelocity Busy Active CommandAborted Error ErrorID"},
        {"Drive_Torque",
         "Axis | Execute Torque TorqueRamp Velocity Direction BufferMode | InTorque Busy Active CommandAborted Error ErrorID"},
    };
    return documents;
}

TEST(PinTables, OfTheOtherMotionBlocksFollowTheirDocuments) {
    for (const auto& [name, pins] : other_documents())
        if (const BlockType* type = find_block_type(name)) {
            EXPECT_EQ(pin_names(*type), pins) << name;
        }
}

// Every block is of Part 1 or has its pins checked against another document.
TEST(PinTables, EveryMotionBlockIsCheckedAgainstADocument) {
    const auto standard = standard_blocks();
    for (const BlockType& type : motion_block_types()) {
        const std::string name{type.name};
        EXPECT_TRUE(standard.contains(name) || other_documents().contains(name)) << name;
    }
}

// P1-009
TEST(PinTables, AllBlocksOfPart1AreThere) {
    const auto standard = standard_blocks();
    EXPECT_EQ(standard.size(), part1::block_count);
    for (const auto& [name, pins] : standard) EXPECT_NE(find_block_type(name), nullptr) << name;
}

// IEC 61131-3 ed. 3, tables 43 to 46.
TEST(PinTables, OfTheIecBlocksFollowTheirStandard) {
    const std::map<std::string_view, std::string> expected{
        {"SR", "S1 R | Q1"},    {"RS", "S R1 | Q1"},     {"R_TRIG", "CLK | Q"},   {"F_TRIG", "CLK | Q"},
        {"TP", "IN PT | Q ET"}, {"TON", "IN PT | Q ET"}, {"TOF", "IN PT | Q ET"},
    };
    for (const auto& [name, pins] : expected) {
        const BlockType* type = find_block_type(name);
        ASSERT_NE(type, nullptr) << name;
        EXPECT_EQ(pin_names(*type), pins) << name;
    }
    const std::map<std::string_view, std::string> counters{
        {"CTU", "CU R PV | Q CV"}, {"CTD", "CD LD PV | Q CV"}, {"CTUD", "CU CD R LD PV | QU QD CV"}};
    for (const auto& [base, pins] : counters)
        for (const std::string variant : {"", "_DINT", "_LINT", "_UDINT", "_ULINT"}) {
            const BlockType* type = find_block_type(std::string{base} + variant);
            ASSERT_NE(type, nullptr) << base << variant;
            EXPECT_EQ(pin_names(*type), pins) << type->name;
            EXPECT_EQ(type->pin("CV")->type.name, variant.empty() ? "INT" : variant.substr(1));
        }
}

TEST(PinTables, OffsetsAreThoseOfTheMembers) {
    MC_MoveAbsolute move;
    const auto at = [&move](const auto& member) {
        return static_cast<std::size_t>(reinterpret_cast<const char*>(&member) - reinterpret_cast<const char*>(&move));
    };
    const BlockType& type = *find_block_type("MC_MoveAbsolute");
    EXPECT_EQ(type.pin("Axis")->offset, at(move.Axis));
    EXPECT_EQ(type.pin("Execute")->offset, at(move.Execute));
    EXPECT_EQ(type.pin("Velocity")->offset, at(move.Velocity));
    EXPECT_EQ(type.pin("Direction")->offset, at(move.Direction));
    EXPECT_EQ(type.pin("ErrorID")->offset, at(move.ErrorID));
    EXPECT_EQ(type.pin("ErrorID")->size, sizeof(ErrorId));
    EXPECT_EQ(type.pin("Nonsense"), nullptr);
}

TEST(PinTables, PinsLieInsideTheBlockAlignedAndApart) {
    for (const BlockType& type : all_block_types()) {
        std::vector<bool> taken(type.size);
        for (const Pin& pin : type.pins) {
            ASSERT_LE(pin.offset + pin.size, type.size) << type.name << '.' << pin.name;
            for (std::size_t i = 0; i < pin.size; ++i) {
                EXPECT_FALSE(taken[pin.offset + i]) << type.name << '.' << pin.name;
                taken[pin.offset + i] = true;
            }
        }
    }
}

TEST(PinTables, EveryPinIsDocumentedAndPhysicalOnesHaveAUnit) {
    for (const BlockType& type : all_block_types()) {
        EXPECT_FALSE(type.summary.empty()) << type.name;
        for (const Pin& pin : type.pins) {
            EXPECT_FALSE(pin.doc.empty()) << type.name << '.' << pin.name;
            EXPECT_EQ(pin.type.kind == PinKind::LREAL, !pin.unit.empty()) << type.name << '.' << pin.name;
            EXPECT_EQ(pin.type.kind == PinKind::ENUM, !pin.type.values.empty()) << type.name << '.' << pin.name;
        }
    }
}

TEST(BlockBytes, ATimerRunsWithoutItsTypeBeingKnown) {
    const BlockType& type = *find_block_type("TON");
    alignas(16) std::byte instance[64];
    ASSERT_LE(type.size, sizeof instance);
    std::memcpy(instance, type.prototype, type.size);
    const auto set = [&](std::string_view pin, const auto& value) {
        std::memcpy(instance + type.pin(pin)->offset, &value, type.pin(pin)->size);
    };
    const auto q = [&] { return instance[type.pin("Q")->offset] != std::byte{0}; };
    FakeAxes axes;

    set("IN", true);
    set("PT", Duration{std::chrono::milliseconds{2}});
    type.run(instance, axes.context);
    EXPECT_FALSE(q());
    axes.next_scan();
    type.run(instance, axes.context);
    EXPECT_FALSE(q());
    axes.next_scan();
    type.run(instance, axes.context);
    EXPECT_TRUE(q());
}

TEST(BlockBytes, AMovingBlockGoesOnAfterACopyOfItsBytes) {
    FakeAxes axes;
    MC_MoveAbsolute array[3];
    array[0].Axis = {0};
    array[0].Execute = true;
    array[0].Position = 10;
    array[0].Velocity = 1;
    array[0](axes.context);
    axes.next_scan();
    array[0](axes.context);
    ASSERT_TRUE(array[0].Active);

    std::memcpy(static_cast<void*>(&array[2]), &array[0], sizeof array[0]);
    std::memset(static_cast<void*>(&array[0]), 0x5A, sizeof array[0]);
    axes.finish(axes::Outcome::done);
    axes.next_scan();
    array[2](axes.context);

    EXPECT_TRUE(array[2].Done);
    EXPECT_EQ(axes.calls.size(), 1u) << "the copy commanded nothing anew";
}

TEST(BlockBytes, PrototypesAreFreshInstances) {
    EXPECT_TRUE(static_cast<const MC_Power*>(find_block_type("MC_Power")->prototype)->EnablePositive);
    EXPECT_FALSE(static_cast<const MC_Stop*>(find_block_type("MC_Stop")->prototype)->Axis.valid());
}

TEST(AbiHash, ChangesWithNameSizeAndEachPin) {
    const BlockType& type = *find_block_type("TON");
    std::vector<Pin> pins(type.pins.begin(), type.pins.end());
    const auto hash = [&](auto change) {
        BlockType other = type;
        auto copy = pins;
        change(other, copy);
        other.pins = copy;
        return layout_hash(1, other);
    };
    const auto unchanged = hash([](BlockType&, std::vector<Pin>&) {});
    EXPECT_EQ(unchanged, layout_hash(1, type));
    EXPECT_NE(unchanged, hash([](BlockType& t, auto&) { t.name = "TOM"; }));
    EXPECT_NE(unchanged, hash([](BlockType& t, auto&) { t.size += 8; }));
    EXPECT_NE(unchanged, hash([](BlockType&, auto& p) { p[1].name = "PX"; }));
    EXPECT_NE(unchanged, hash([](BlockType&, auto& p) { p[1].offset += 8; }));
    EXPECT_NE(unchanged, hash([](BlockType&, auto& p) { p[1].type = PinTypeOf<std::int64_t>::value; }));
    EXPECT_NE(unchanged, hash([](BlockType&, auto& p) { p.pop_back(); }));
    static constexpr std::array<std::string_view, 2> one_order{"mcA", "mcB"}, other_order{"mcB", "mcA"};
    EXPECT_NE(hash([](BlockType&, auto& p) {
                  p[1].type = {PinKind::ENUM, "MC_E", one_order};
              }),
              hash([](BlockType&, auto& p) {
                  p[1].type = {PinKind::ENUM, "MC_E", other_order};
              }));
    EXPECT_EQ(unchanged, hash([](BlockType&, auto& p) { p[1].doc = "a better text"; })) << "documentation is no ABI";
}

TEST(BlockReference, NamesEveryBlockPinAndUnit) {
    const std::string page = block_reference_markdown();
    for (const BlockType& type : all_block_types()) EXPECT_THAT(page, HasSubstr("\n### " + std::string{type.name} + "\n"));
    EXPECT_THAT(page, HasSubstr("| Velocity | in | LREAL | u/s | signed; the sense times Direction; 0 is allowed |"));
    EXPECT_THAT(page, HasSubstr("### MC_BUFFER_MODE\n\n0 mcAborting, 1 mcBuffered, 2 mcBlendingLow, 3 mcBlendingPrevious, 4 "
                                "mcBlendingNext, 5 mcBlendingHigh\n"));
}

}  // namespace
}  // namespace taktwerk::fb
