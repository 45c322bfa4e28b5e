// One idea a room, on the real tree and on small classes that hold more, so that a count which sees nothing fails too.

#include "tests/architecture/rooms.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace taktwerk::architecture {
namespace {

/// Records: values that belong side by side, with at most the questions that they answer by themselves. And what is as large for a reason.
const std::vector<Leave> large_classes{
    {"axes/axis/axis_view.hpp", "AxisView", 71, "record: everything that one cycle shows of an axis, in one copy"},
    {"axes/port/drive_profile.hpp", "DriveProfile", 52, "record: what a drive type is; its rooms are structs in it"},
    {"axes/group/group_view.hpp", "GroupView", 63, "record: what everybody sees of a group, in one copy"},
    {"axes/port/drive_feedback.hpp", "DriveFeedback", 32, "record: what a drive says in one cycle"},
    {"axes/port/drive_capabilities.hpp", "DriveCapabilities", 30, "record: what a drive can"},
    {"axes/sim/axis_objects.hpp", "AxisInputs", 31, "record: the objects that a master writes"},
    {"axes/drives/xp200/drive_mailbox.hpp", "Sample", 28, "record: what a drive was last seen to do"},
    {"runtime/snapshot.hpp", "Snapshot", 31, "record: one cycle of the machine, in one copy"},
    {"ecat/cycle/cycle_link.hpp", "CycleLink", 29, "record: plain numbers that cross between two threads, each an atomic of its own"},
    {"axes/axis/axis_core.hpp", "AxisCore", 29,
     "the parts of an axis and nothing else: each is a class, laid out by how often a cycle reads it"},
    {"axes/axis/axis_body.hpp", "AxisBody", 29,
     "record: what every part of an axis reads in each cycle, side by side in a few cache lines"},
};

const std::vector<Leave> long_headers{
    {"axes/axis/error_texts.hpp", "", 387, "one table: a row for each error"},
};

const std::vector<SourceFile>& all_floors() {
    static const std::vector<SourceFile> files = [] {
        std::vector<SourceFile> all;
        for (const auto& level : floor_levels())
            for (const auto& floor : level)
                for (auto& file : read_sources(TAKTWERK_SOURCE_DIR, floor)) all.push_back(std::move(file));
        return all;
    }();
    return files;
}

std::string lines_of(const Violations& violations) {
    std::string text;
    for (const auto& violation : violations) text += violation + "\n";
    return text;
}

std::size_t members_of(const std::string& text, const std::string& name) {
    for (const auto& room : class_rooms(text))
        if (room.name == name) return room.members;
    return 999;
}

std::string with_members(std::size_t count) {
    std::string text = "class Large {\n";
    for (std::size_t i = 0; i < count; ++i) text += "    int member_" + std::to_string(i) + "_ = 0;\n";
    return text + "};\n";
}

TEST(Rooms, NoClassHasMoreThan25DataMembers) { EXPECT_EQ(lines_of(check_class_sizes(all_floors(), large_classes)), ""); }
TEST(Rooms, NoHeaderIsLongerThan250Lines) { EXPECT_EQ(lines_of(check_header_lengths(all_floors(), long_headers)), ""); }

TEST(Rooms, TheClassesOfTheTreeAreSeen) {
    std::size_t classes = 0, members = 0;
    for (const auto& file : all_floors())
        for (const auto& room : class_rooms(file.text)) ++classes, members += room.members;
    EXPECT_GT(classes, 1000u);
    EXPECT_GT(members, 4000u);
}

TEST(Rooms, OneMemberTooManyIsSeenWithFileAndLine) {
    EXPECT_THAT(check_class_sizes({{"core/a.hpp", "\n" + with_members(26)}}, {}),
                testing::ElementsAre("core/a.hpp:2: Large has 26 data members: more than one idea"));
    EXPECT_TRUE(check_class_sizes({{"core/a.hpp", with_members(25)}}, {}).empty());
}

TEST(Rooms, OneLineTooManyIsSeenInAHeaderOnly) {
    const std::string text(251, '\n');
    EXPECT_THAT(check_header_lengths({{"core/a.hpp", text}, {"core/a.cpp", text}, {"core/b.hpp", text.substr(1)}}, {}),
                testing::ElementsAre("core/a.hpp has 251 lines: more than one idea"));
}

TEST(Rooms, LeaveIsForSoManyAndForAReason) {
    const std::vector<SourceFile> files{{"core/a.hpp", with_members(27)}};
    EXPECT_TRUE(check_class_sizes(files, {{"core/a.hpp", "Large", 27, "record"}}).empty());
    EXPECT_EQ(check_class_sizes(files, {{"core/a.hpp", "Large", 26, "record"}}).size(), 1u);
    EXPECT_EQ(check_class_sizes(files, {{"core/a.hpp", "Large", 27, ""}}).size(), 1u);
    EXPECT_THAT(check_class_sizes({{"core/a.hpp", with_members(25)}}, {{"core/a.hpp", "Large", 27, "record"}}),
                testing::ElementsAre("core/a.hpp: Large has leave to be larger and does not need it"));
}

TEST(Rooms, DataMembersAreCountedAndNothingElse) {
    EXPECT_EQ(members_of("class A {\npublic:\n    A() : a_{1}, b_(2) { int local = 0; }\n    int f() const { return a_; }\n"
                         "    A& operator=(const A&) = default;\n    static int count;\n    static constexpr int most = 3;\n"
                         "    using B = int;\n    friend class C;\n    enum class E { x, y };\n    struct Later;\n"
                         "    template <class T> T g(T t);\n    [[nodiscard]] bool h(int x = 3) const noexcept;\n"
                         "private:\n    int a_, b_ = 2;\n};\n",
                         "A"),
              2u);
    EXPECT_EQ(members_of("struct A { int a = f(1, 2), b{3}, *c; };", "A"), 3u);
    EXPECT_EQ(members_of("struct A { std::map<int, std::array<int, 3>> a, b; };", "A"), 2u);
    EXPECT_EQ(members_of("struct A { std::function<void(int, int)> a; void (*b)(int); int c[3] = {1, 2, 3}; };", "A"), 3u);
    EXPECT_EQ(members_of("struct A { bool a = 1 < 2, b = 3 > 2; unsigned c : 3, d : 1; const B& e; };", "A"), 5u);
    EXPECT_EQ(members_of("struct alignas(64) A final : B<1, 2> { std::atomic<int> a{0}; // int b;\n};", "A"), 1u);
    EXPECT_EQ(members_of("enum class A { a, b, c };", "A"), 999u);
    EXPECT_EQ(members_of("class A;\nvoid f(struct A* a);\n", "A"), 999u);
}

TEST(Rooms, AClassInAClassHasItsOwnCount) {
    const std::string text =
        "class A {\n    struct B { int a, b, c; };\n    struct C { int a; } c_, d_;\n    enum { x, y } e_;\n    B b_;\n};\n";
    EXPECT_EQ(members_of(text, "A"), 4u);
    EXPECT_EQ(members_of(text, "B"), 3u);
    EXPECT_EQ(members_of(text, "C"), 1u);
}

}  // namespace
}  // namespace taktwerk::architecture
