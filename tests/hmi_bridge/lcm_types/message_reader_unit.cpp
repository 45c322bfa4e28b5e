// Messages of our types read without lcm-gen's code, held against what lcm-gen's code says; and bytes that mean harm.
#include "hmi_bridge/lcm_types/message_reader.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <cstring>

#include <nlohmann/json.hpp>

#include "hmi_bridge/lcm_types/our_types.hpp"
#include "hmi_bridge/lcm_types/shown_message.hpp"
#include "taktwerk_lcm/acknowledge_v1_t.hpp"
#include "taktwerk_lcm/alarm_list_v1_t.hpp"
#include "taktwerk_lcm/axis_holder_v1_t.hpp"
#include "taktwerk_lcm/axis_state_v1_t.hpp"
#include "taktwerk_lcm/command_event_v1_t.hpp"
#include "taktwerk_lcm/command_v1_t.hpp"
#include "taktwerk_lcm/cycle_statistics_v1_t.hpp"
#include "taktwerk_lcm/heartbeat_v1_t.hpp"
#include "taktwerk_lcm/io_state_v1_t.hpp"
#include "taktwerk_lcm/machine_state_v1_t.hpp"
#include "taktwerk_lcm/program_values_v1_t.hpp"
#include "taktwerk_lcm/whole_alarm_v1_t.hpp"
#include "taktwerk_lcm/whole_axis_v1_t.hpp"
#include "taktwerk_lcm/whole_bus_v1_t.hpp"
#include "taktwerk_lcm/whole_event_v1_t.hpp"
#include "taktwerk_lcm/whole_force_v1_t.hpp"
#include "taktwerk_lcm/whole_giver_v1_t.hpp"
#include "taktwerk_lcm/whole_measure_v1_t.hpp"
#include "taktwerk_lcm/whole_point_v1_t.hpp"
#include "taktwerk_lcm/whole_program_v1_t.hpp"
#include "taktwerk_lcm/whole_slave_v1_t.hpp"
#include "taktwerk_lcm/whole_state_v1_t.hpp"
#include "taktwerk_lcm/whole_state_v2_t.hpp"
#include "taktwerk_lcm/whole_state_v3_t.hpp"
#include "taktwerk_lcm/whole_state_v4_t.hpp"
#include "taktwerk_lcm/whole_state_v5_t.hpp"
#include "taktwerk_lcm/whole_statistics_v1_t.hpp"
#include "taktwerk_lcm/whole_statistics_v2_t.hpp"
#include "taktwerk_lcm/whole_task_v1_t.hpp"
#include "taktwerk_lcm/whole_value_v1_t.hpp"

namespace taktwerk::hmi {
namespace {

using namespace taktwerk_lcm;
using ::testing::Contains;
using ::testing::HasSubstr;

template <class Message>
std::vector<std::byte> encoded(const Message& message) {
    std::vector<std::byte> bytes(static_cast<std::size_t>(message.getEncodedSize()));
    EXPECT_EQ(message.encode(bytes.data(), 0, static_cast<int>(bytes.size())), static_cast<int>(bytes.size()));
    return bytes;
}

const TypeCatalog& ours() {
    static const auto catalog = our_types();
    return catalog;
}
const LcmType& type(const char* name) { return *ours().find(std::string("taktwerk_lcm.") + name); }

alarm_list_v1_t two_alarms() {
    alarm_list_v1_t list{};
    list.utime = 1'764'109'646'125'000;
    list.total = list.alarm_count = 2;
    list.alarm.resize(2);
    list.alarm[0].name = "following_error";
    list.alarm[0].reaction = alarm_v1_t::REACTION_STOP_AXIS;
    list.alarm[1].chinese = "跟随误差过大";
    list.alarm[1].standing = 1;
    return list;
}

TEST(TypeCatalog, FingerprintsAreThoseOfLcmGen) {
    const auto expect = [](const char* name, std::int64_t generated) {
        const auto made = ours().fingerprint(type(name));
        ASSERT_TRUE(made) << name;
        EXPECT_EQ(*made, static_cast<std::uint64_t>(generated)) << name;
        EXPECT_EQ(ours().find(*made), &type(name));
    };
    EXPECT_EQ(ours().types().size(), 38u) << "a new type: a line here";
    expect("acknowledge_v1_t", acknowledge_v1_t::getHash());
    expect("alarm_list_v1_t", alarm_list_v1_t::getHash());
    expect("alarm_v1_t", alarm_v1_t::getHash());
    expect("axis_holder_v1_t", axis_holder_v1_t::getHash());
    expect("axis_state_v1_t", axis_state_v1_t::getHash());
    expect("command_event_v1_t", command_event_v1_t::getHash());
    expect("command_v1_t", command_v1_t::getHash());
    expect("cycle_statistics_v1_t", cycle_statistics_v1_t::getHash());
    expect("heartbeat_v1_t", heartbeat_v1_t::getHash());
    expect("io_state_v1_t", io_state_v1_t::getHash());
    expect("machine_state_v1_t", machine_state_v1_t::getHash());
    expect("program_values_v1_t", program_values_v1_t::getHash());
    expect("whole_alarm_v1_t", whole_alarm_v1_t::getHash());
    expect("whole_axis_v1_t", whole_axis_v1_t::getHash());
    expect("whole_bus_v1_t", whole_bus_v1_t::getHash());
    expect("whole_event_v1_t", whole_event_v1_t::getHash());
    expect("whole_force_v1_t", whole_force_v1_t::getHash());
    expect("whole_giver_v1_t", whole_giver_v1_t::getHash());
    expect("whole_measure_v1_t", whole_measure_v1_t::getHash());
    expect("whole_point_v1_t", whole_point_v1_t::getHash());
    expect("whole_program_v1_t", whole_program_v1_t::getHash());
    expect("whole_slave_v1_t", whole_slave_v1_t::getHash());
    expect("whole_state_v1_t", whole_state_v1_t::getHash());
    expect("whole_group_member_v1_t", whole_group_member_v1_t::getHash());
    expect("whole_group_v1_t", whole_group_v1_t::getHash());
    expect("whole_state_v2_t", whole_state_v2_t::getHash());
    expect("whole_state_v3_t", whole_state_v3_t::getHash());
    expect("whole_state_v4_t", whole_state_v4_t::getHash());
    expect("whole_group_v2_t", whole_group_v2_t::getHash());
    expect("whole_state_v5_t", whole_state_v5_t::getHash());
    expect("whole_group_v3_t", whole_group_v3_t::getHash());
    expect("whole_refusal_v1_t", whole_refusal_v1_t::getHash());
    expect("whole_event_v2_t", whole_event_v2_t::getHash());
    expect("whole_group_frame_v1_t", whole_group_frame_v1_t::getHash());
    expect("whole_statistics_v1_t", whole_statistics_v1_t::getHash());
    expect("whole_statistics_v2_t", whole_statistics_v2_t::getHash());
    expect("whole_task_v1_t", whole_task_v1_t::getHash());
    expect("whole_value_v1_t", whole_value_v1_t::getHash());
}

TEST(TypeText, ReadsWhatLcmGenReads) {
    TypeCatalog catalog;
    ASSERT_TRUE(catalog.add(
        "/* a comment\n over lines */ package exlcm;\nstruct example_t {\n int64_t timestamp; // us\n double position[3], other[3];\n"
        " int32_t n; int16_t ranges[n][2]; const int32_t A = 1, B = 0x10; const double PI = 3.14; point_t p; }\nstruct point_t { byte x; }",
        "example.lcm"));
    const auto* found = catalog.find("exlcm.example_t");
    ASSERT_NE(found, nullptr);
    ASSERT_EQ(found->fields.size(), 6u);
    EXPECT_EQ(found->fields[0].comment, "us");
    EXPECT_EQ(found->fields[2].dimensions.at(0).fixed, 3);
    EXPECT_EQ(found->fields[4].dimensions.at(0).size, "n");
    EXPECT_EQ(found->fields[5].type, "exlcm.point_t");
    ASSERT_EQ(found->constants.size(), 2u);
    EXPECT_EQ(found->constants[1].value, 16);
}

TEST(TypeText, SaysWhereItIsWrong) {
    for (const auto* text :
         {"strukt a_t {}", "struct a_t { int32_t }", "struct a_t { int32_t x }", "struct a_t { double x[n]; }",
          "struct a_t { double x[-1]; }", "struct a_t {", "struct", "package", "enum e { A }", "struct a_t { const int32_t A; }"}) {
        const auto read = parse_lcm_text(text, "x.lcm");
        ASSERT_FALSE(read) << text;
        EXPECT_EQ(read.error().code, "lcm.type_text");
        EXPECT_THAT(read.error().subject, HasSubstr("x.lcm:1"));
    }
}

TEST(TypeCatalog, ATypeWithoutItsPartsHasNoFingerprintAndOneThatHoldsItselfEnds) {
    TypeCatalog catalog;
    ASSERT_TRUE(catalog.add("struct a_t { b_t b; } struct list_t { int32_t n; list_t rest[n]; }", "x.lcm"));
    EXPECT_FALSE(catalog.fingerprint(*catalog.find("a_t")));
    EXPECT_TRUE(catalog.fingerprint(*catalog.find("list_t")));
}

TEST(MessageReader, ReadsEveryFieldOfAnAxis) {
    axis_state_v1_t axis{};
    axis.utime = 1'764'109'646'125'000;
    axis.seq = -1;
    axis.name = "x";
    axis.unit = "mm";
    axis.state = axis_state_v1_t::STATE_DISCRETE_MOTION;
    axis.actual_position = 12.125;
    axis.set_velocity = std::nan("");
    axis.homed = 1;
    axis.status_word = 0x1637;
    const auto read = read_message(ours(), type("axis_state_v1_t"), encoded(axis));
    ASSERT_TRUE(read) << read.error().text();
    EXPECT_EQ((*read)["utime"], 1'764'109'646'125'000);
    EXPECT_EQ((*read)["seq"], -1);
    EXPECT_EQ((*read)["name"], "x");
    EXPECT_EQ((*read)["actual_position"], 12.125);
    EXPECT_TRUE(std::isnan((*read)["set_velocity"].get<double>()));
    EXPECT_EQ((*read)["homed"], true);
    EXPECT_EQ((*read)["powered"], false);
    EXPECT_EQ((*read)["status_word"], 0x1637);

    const auto lines = shown_lines(ours(), type("axis_state_v1_t"), *read);
    EXPECT_THAT(lines, Contains("actual_position: 12.125 mm"));
    EXPECT_THAT(lines, Contains("set_velocity: nan mm/s"));
    EXPECT_THAT(lines, Contains("state: 3 DISCRETE_MOTION"));
    EXPECT_THAT(lines, Contains("utime: 1764109646125000 us (2025-11-25 22:27:26.125000 UTC)"));
    EXPECT_THAT(lines, Contains("homed: true"));
}

TEST(MessageReader, ReadsStructsInArraysAndConstantsOfOtherTypes) {
    const auto read = read_message(ours(), type("alarm_list_v1_t"), encoded(two_alarms()));
    ASSERT_TRUE(read) << read.error().text();
    EXPECT_EQ((*read)["alarm"][1]["chinese"], "跟随误差过大");
    EXPECT_EQ((*read)["alarm"][1]["standing"], true);
    const auto lines = shown_lines(ours(), type("alarm_list_v1_t"), *read);
    EXPECT_THAT(lines, Contains("alarm[0].name: following_error"));
    EXPECT_THAT(lines, Contains("alarm[0].reaction: 2 STOP_AXIS"));

    machine_state_v1_t machine{};
    machine.mode = command_v1_t::MODE_AUTOMATIC;
    const auto shown = read_message(ours(), type("machine_state_v1_t"), encoded(machine));
    ASSERT_TRUE(shown);
    EXPECT_THAT(shown_lines(ours(), type("machine_state_v1_t"), *shown), Contains("mode: 2 AUTOMATIC")) << "its comment names command_v1_t";
}

TEST(MessageReader, ATargetOfACommandIsAText) {
    command_v1_t command{};
    std::memcpy(command.target, "x", 1);
    auto read = read_message(ours(), type("command_v1_t"), encoded(command));
    ASSERT_TRUE(read);
    EXPECT_EQ((*read)["target"], "x");
    command.target[5] = 7;
    read = read_message(ours(), type("command_v1_t"), encoded(command));
    ASSERT_TRUE(read);
    EXPECT_THAT((*read)["target"].get<std::string>(), HasSubstr("780000000007")) << "no text: its bytes";
}

TEST(MessageReader, EveryShorterAndEveryLongerMessageIsRefused) {
    auto bytes = encoded(two_alarms());
    ASSERT_TRUE(check_message(ours(), type("alarm_list_v1_t"), bytes));
    for (std::size_t size = 0; size < bytes.size(); ++size)
        EXPECT_FALSE(check_message(ours(), type("alarm_list_v1_t"), std::span(bytes).first(size))) << size;
    bytes.push_back(std::byte{0});
    const auto longer = check_message(ours(), type("alarm_list_v1_t"), bytes);
    ASSERT_FALSE(longer);
    EXPECT_EQ(longer.error().code, "lcm.bad_message");
    EXPECT_THAT(longer.error().what, HasSubstr("1 bytes stand behind it"));
}

// The counts with which lcm-gen's decoder reads beyond the message, or throws: 2^31 - 1, -1, and a product that overflows 32 bits.
TEST(MessageReader, CountsAndLengthsAreHeldAgainstWhatIsThere) {
    const auto bytes = encoded(two_alarms());
    const auto with = [&](std::size_t at, std::uint32_t value) {
        auto changed = bytes;
        for (int i = 0; i < 4; ++i) changed[at + static_cast<std::size_t>(i)] = static_cast<std::byte>(value >> (24 - 8 * i));
        return check_message(ours(), type("alarm_list_v1_t"), changed);
    };
    // 8 fingerprint + 8 + 8 + 4 + 8 + 8 + 4 + 4: alarm_count; then its first alarm: 4 of id, then the length of its name.
    constexpr std::size_t count_at = 52, length_at = 60;
    ASSERT_TRUE(with(count_at, 2));
    ASSERT_TRUE(with(length_at, 16)) << "following_error and its NUL";
    for (const std::uint32_t count : {0x7FFFFFFFu, 0xFFFFFFFFu, 0x80000000u, 0x20000000u, 0x10000001u, 3u, 1u, 0u})
        EXPECT_FALSE(with(count_at, count)) << count;
    for (const std::uint32_t length : {0u, 0xFFFFFFFFu, 0x7FFFFFFFu, 0x80000000u, 15u, 17u})
        EXPECT_FALSE(with(length_at, length)) << length;
}

TEST(MessageReader, ArraysOfNothingEndToo) {
    TypeCatalog catalog;
    ASSERT_TRUE(catalog.add("struct none_t { } struct many_t { int32_t n; none_t nothing[n]; double flat[n][0]; }", "x.lcm"));
    const auto& many = *catalog.find("many_t");
    std::vector<std::byte> message;
    const auto fingerprint = *catalog.fingerprint(many);
    for (int i = 7; i >= 0; --i) message.push_back(static_cast<std::byte>(fingerprint >> (8 * i)));
    for (const int b : {0x7F, 0xFF, 0xFF, 0xFF}) message.push_back(static_cast<std::byte>(b));
    EXPECT_FALSE(check_message(catalog, many, message));
}

TEST(MessageReader, AnotherTypeIsRefusedByItsFingerprint) {
    const auto wrong = check_message(ours(), type("heartbeat_v1_t"), encoded(two_alarms()));
    ASSERT_FALSE(wrong);
    EXPECT_EQ(wrong.error().code, "lcm.not_this_type");
}

}  // namespace
}  // namespace taktwerk::hmi
