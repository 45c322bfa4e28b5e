// What the page's server decides without a socket: roles, origin, age, what waits for a page, what a page may say.

#include <filesystem>
#include <fstream>
#include <map>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hmi_bridge/web/held_buttons.hpp"
#include "hmi_bridge/web/message_age.hpp"
#include "hmi_bridge/web/outbox.hpp"
#include "hmi_bridge/web/page_message.hpp"
#include "hmi_bridge/web/page_origin.hpp"
#include "hmi_bridge/web/page_seats.hpp"
#include "hmi_bridge/web/question_turns.hpp"
#include "hmi_bridge/web/site_files.hpp"

namespace taktwerk::hmi::web {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

// Written apart from the table in roles.hpp, from what each command does (hmi_bridge/README.md): viewer, operator, engineer, admin.
TEST(PageRoles, EveryCellOfRoleAndCommand) {
    const std::map<std::string, std::string> expected{{"hello", "yyyy"},
                                                      {"layout", "yyyy"},
                                                      {"state", "yyyy"},
                                                      {"alarms", "yyyy"},
                                                      {"views", "yyyy"},
                                                      {"view_image", "yyyy"},
                                                      {"set_value", "nyyy"},
                                                      {"alarm_history", "yyyy"},
                                                      {"measure", "nnyy"},
                                                      {"measure_plan", "yyyy"},
                                                      {"measure_result", "yyyy"},
                                                      {"drive_read", "yyyy"},
                                                      {"stop", "yyyy"},
                                                      {"take_control", "nyyy"},
                                                      {"release_control", "nyyy"},
                                                      {"mode", "nyyy"},
                                                      {"enable", "nyyy"},
                                                      {"disable", "nyyy"},
                                                      {"home", "nyyy"},
                                                      {"jog", "nyyy"},
                                                      {"move", "nyyy"},
                                                      {"reset", "nyyy"},
                                                      {"program_start", "nyyy"},
                                                      {"program_stop", "nyyy"},
                                                      {"program_reset", "nyyy"},
                                                      {"acknowledge", "nyyy"},
                                                      {"set_parameter", "nnyy"},
                                                      {"set_output", "nnyy"},
                                                      {"simulate", "nnyy"},
                                                      {"drive_write", "nnyy"},
                                                      {"drive_store", "nnyy"},
                                                      {"override", "nyyy"},
                                                      {"group_halt", "yyyy"},
                                                      {"group_interrupt", "nyyy"},
                                                      {"group_continue", "nyyy"},
                                                      {"group_override", "nyyy"},
                                                      {"group_reset", "nyyy"},
                                                      {"group_enable", "nyyy"},
                                                      {"group_disable", "nyyy"},
                                                      {"group_jog", "nyyy"},
                                                      {"reset_peaks", "nyyy"},
                                                      {"force", "nnyy"},
                                                      {"unforce", "nnyy"},
                                                      {"release_forces", "nnyy"},
                                                      {"reset_statistics", "nnyy"},
                                                      {"histograms", "yyyy"},
                                                      {"bus", "yyyy"},
                                                      {"drive_parameters", "yyyy"},
                                                      {"log", "nyyy"},
                                                      {"shutdown", "nnny"},
                                                      {"scope_signals", "yyyy"},
                                                      {"scope_read", "yyyy"},
                                                      {"scope_arm", "yyyy"},
                                                      {"scope_state", "yyyy"},
                                                      {"scope_disarm", "yyyy"},
                                                      {"recordings", "yyyy"},
                                                      {"recording_signals", "yyyy"},
                                                      {"recording_read", "yyyy"},
                                                      {"recording_part", "nyyy"},
                                                      {"replay_keep", "nyyy"},
                                                      {"replay_state", "yyyy"}};
    EXPECT_EQ(command_rules.size(), expected.size());
    for (const auto& row : expected) {
        const auto* rule = find_rule(row.first);
        ASSERT_NE(rule, nullptr) << row.first;
        std::string cells;
        for (const char* role : {"viewer", "operator", "engineer", "admin"}) cells += may(role_of(role).value(), *rule) ? 'y' : 'n';
        EXPECT_EQ(cells, row.second) << row.first;
    }
    EXPECT_EQ(find_rule("format_disk"), nullptr);
    EXPECT_FALSE(role_of("root"));
}

TEST(PageOriginRule, OnlyItsOwnNamesAndItsOwnPage) {
    const PageOrigin origin("127.0.0.1", 8080);
    for (const char* host : {"127.0.0.1:8080", "localhost:8080", "LocalHost:8080", "[::1]:8080"})
        EXPECT_TRUE(origin.knows_host(host)) << host;
    for (const char* host : {"", "127.0.0.1", "127.0.0.1:80", "evil.example:8080", "localhost.evil.example:8080", "localhost:8080 "})
        EXPECT_FALSE(origin.knows_host(host)) << host;
    EXPECT_TRUE(origin.is_own("http://localhost:8080", "localhost:8080"));
    EXPECT_TRUE(origin.is_own("https://127.0.0.1:8080", "127.0.0.1:8080"));
    for (const char* foreign :
         {"", "null", "http://evil.example", "http://evil.example:8080", "http://localhost:8081", "file://localhost:8080",
          "http://127.0.0.1:8080", "http://localhost:8080.evil.example", "http://localhost:8080/"})
        EXPECT_FALSE(origin.is_own(foreign, "localhost:8080")) << foreign;
    // A foreign name that was made to point here: page and host agree, and both are unknown.
    EXPECT_FALSE(origin.is_own("http://evil.example:8080", "evil.example:8080"));
    EXPECT_TRUE(PageOrigin("127.0.0.1", 80).knows_host("localhost"));
}

TEST(PageOriginRule, LoopbackIsLoopbackAlone) {
    for (const char* address : {"127.0.0.1", "127.9.8.7", "::1"}) EXPECT_TRUE(is_loopback(address)) << address;
    for (const char* address : {"0.0.0.0", "::", "192.168.1.2", "128.0.0.1", "localhost", "", "::ffff:10.0.0.1"})
        EXPECT_FALSE(is_loopback(address)) << address;
}

TEST(MessageAgeRule, WhatWaitedIsOldByAsLongAsItWaited) {
    MessageAge age;
    const Instant start{100s};
    EXPECT_EQ(age.of(5000, start), 0ms);  // the clocks' difference, and the way
    EXPECT_LE(age.of(5050, start + 50ms), 1ms);
    // The network stalls for 400 ms, then hands on what was sent each 50 ms.
    EXPECT_GT(age.of(5100, start + 500ms), 390ms);
    EXPECT_GT(age.of(5150, start + 500ms), 340ms);
    EXPECT_LE(age.of(5500, start + 500ms), 1ms);
    // A message that was quicker than the first one: that was the way's length.
    EXPECT_EQ(age.of(6010, start + 1000ms), 0ms);
    EXPECT_GE(age.of(6050, start + 1050ms), 9ms);
}

TEST(MessageAgeRule, APageWhoseQuartzIsSlowStaysYoungAllDay) {
    MessageAge age;
    for (int minute = 0; minute < 24 * 60; ++minute)
        ASSERT_LT(age.of(minute * 60'000.0 * (1 - 100e-6), Instant{minute * 60s}), 1ms) << minute;
}

// Nobody touched the page for hours; then a stall of three seconds, and what it held back comes at once. The two clocks may have gone apart by seconds.
TEST(MessageAgeRule, AfterALongSilenceNothingIsTakenForYoung) {
    MessageAge age;
    EXPECT_EQ(age.of(0, Instant{1000s}), 0ms);
    const Instant later = Instant{1000s} + 8h;
    const double sent = 8 * 3600e3;
    for (int i = 0; i < 10; ++i) EXPECT_GT(age.of(sent + 50.0 * i, later + 3s), MessageAge::longest) << i;
    EXPECT_LT(age.of(sent + 3400, later + 3400ms), MessageAge::longest_of_jog) << "given again, it counts";
}

TEST(MessageAgeRule, APageThatSaysItsTimeStaysYoungAndAStallIsSeenAtOnce) {
    MessageAge age;
    for (int second = 0; second <= 8 * 3600; second += 2) ASSERT_LT(age.of(second * 1000.0 * (1 - 100e-6), Instant{second * 1s}), 1ms);
    EXPECT_GT(age.of(8 * 3600e3 * (1 - 100e-6) + 200, Instant{8h} + 700ms), 450ms);
}

TEST(MessageAgeRule, AClockThatJumpedIsOldNotOverflown) {
    MessageAge age;
    (void)age.of(1e300, Instant{1s});
    EXPECT_GT(age.of(0, Instant{2s}), MessageAge::longest);
}

TEST(PageOutbox, OfValuesOnlyTheNewestWaits) {
    Outbox out;
    for (int i = 0; i < 1000; ++i) out.put_state(std::make_shared<const std::string>("\"n\":" + std::to_string(i) + "}"), Instant{1s});
    EXPECT_EQ(*out.next(Instant{1s} + 70ms), R"({"type":"state","age_ms":70,"n":999})");
    EXPECT_EQ(out.next(Instant{2s}), nullptr);
    EXPECT_TRUE(out.empty());
}

TEST(PageOutbox, WhatDoesNotFitIsCountedWhereItIsMissing) {
    Outbox out;
    for (std::size_t i = 0; i < Outbox::most_messages + 3; ++i) EXPECT_EQ(out.put(std::to_string(i)), i < Outbox::most_messages);
    for (std::size_t i = 0; i < Outbox::most_messages; ++i) EXPECT_EQ(*out.next(Instant{}), std::to_string(i));
    EXPECT_EQ(*out.next(Instant{}), R"({"type":"gap","missed":3})");
    EXPECT_TRUE(out.put("again"));
    EXPECT_FALSE(out.put(std::string(Outbox::most_bytes, 'x')));
}

TEST(PageOutbox, ALongAnswerIsOvertakenByWhatIsShortAndTakesTurnsWithTheValues) {
    Outbox out;
    const std::string first(Outbox::long_from, 'a'), second(Outbox::most_long_bytes - Outbox::long_from, 'b');
    EXPECT_TRUE(out.put_answer(first));
    EXPECT_TRUE(out.put_answer(second));
    EXPECT_TRUE(out.put_answer("short"));
    const auto values = std::make_shared<const std::string>("}");
    out.put_state(values, Instant{});
    EXPECT_EQ(*out.next(Instant{}), "short");
    EXPECT_EQ(*out.next(Instant{}), R"({"type":"state","age_ms":0,})");
    out.put_state(values, Instant{});
    EXPECT_EQ(*out.next(Instant{}), first);
    EXPECT_EQ(*out.next(Instant{}), R"({"type":"state","age_ms":0,})");
    EXPECT_FALSE(out.put_answer(std::string(Outbox::most_long_bytes, 'c'))) << "beside the second it does not fit, nor among the short";
    EXPECT_EQ(*out.next(Instant{}), R"({"type":"gap","missed":1})");
    EXPECT_EQ(*out.next(Instant{}), second);
    EXPECT_TRUE(out.empty());
}

PageMessage message_of(const std::string& text) {
    auto read = read_page_message(text);
    if (const auto* unread = std::get_if<UnreadMessage>(&read)) ADD_FAILURE() << text << ": " << unread->error.text();
    return std::holds_alternative<PageMessage>(read) ? std::get<PageMessage>(read) : PageMessage{};
}

std::string code_of(const std::string& text) {
    const auto read = read_page_message(text);
    return std::holds_alternative<UnreadMessage>(read) ? std::get<UnreadMessage>(read).error.code : "";
}

TEST(PageMessages, ACommandIsTheSocketsOwn) {
    const auto jog =
        message_of(R"({"type":"command","id":7,"machine":"demo","cmd":"jog","axis":"x","velocity":-2.5,"press":true,"sent_ms":12.5})");
    EXPECT_EQ(jog.id, 7);
    EXPECT_EQ(jog.machine, "demo");
    EXPECT_EQ(jog.sent_ms, 12.5);
    EXPECT_TRUE(jog.may_move());
    EXPECT_EQ(jog.request.dump(), R"({"cmd":"jog","axis":"x","velocity":-2.5,"press":true})");
    EXPECT_FALSE(message_of(R"({"type":"command","id":8,"cmd":"jog","axis":"x","velocity":0})").may_move());
    // A velocity that is no number must not pass as a jog let go.
    EXPECT_TRUE(message_of(R"({"type":"command","id":8,"cmd":"jog","axis":"x","velocity":"0"})").may_move());
    EXPECT_TRUE(message_of(R"({"type":"command","id":8,"cmd":"jog","axis":"x"})").may_move());
    EXPECT_FALSE(message_of(R"({"type":"command","id":9,"cmd":"stop"})").may_move());
    EXPECT_EQ(message_of(R"({"type":"watch","machine":"saw"})").kind, PageMessage::Kind::watch);
}

TEST(PageMessages, HostileOnesAreRefusedByName) {
    EXPECT_EQ(code_of(""), "web.not_json");
    EXPECT_EQ(code_of("{"), "web.not_json");
    EXPECT_EQ(code_of("[1]"), "web.not_an_object");
    EXPECT_EQ(code_of("{}"), "web.type");
    EXPECT_EQ(code_of(R"({"type":7})"), "web.key");
    EXPECT_EQ(code_of(R"({"type":"command","cmd":"stop"})"), "web.id");
    EXPECT_EQ(code_of(R"({"type":"command","id":1.5,"cmd":"stop"})"), "web.id");
    EXPECT_EQ(code_of(R"({"type":"command","id":0,"cmd":"stop"})"), "web.id");
    EXPECT_EQ(code_of(R"({"type":"command","id":18446744073709551615,"cmd":"stop"})"), "web.id");
    EXPECT_EQ(code_of(R"({"type":"command","id":1,"cmd":"format"})"), "web.unknown_command");
    EXPECT_EQ(code_of(R"({"type":"command","id":1,"cmd":"move","utime":5})"), "web.key");
    EXPECT_EQ(code_of(R"({"type":"command","id":1,"cmd":"move","valid_ms":10000})"), "web.key");
    EXPECT_EQ(code_of(R"({"type":"command","id":1,"cmd":"move","commissioning":true})"), "web.key");
    EXPECT_EQ(code_of(R"({"type":"command","id":1,"cmd":"move","sent_ms":"now"})"), "web.key");
    EXPECT_EQ(code_of(R"({"type":"command","id":1,"cmd":"stop","cmd":"move"})"), "web.duplicate_key");
    EXPECT_EQ(code_of("{\"type\":\"command\",\"id\":1,\"cmd\":\"\xff\xfe\"}"), "web.not_json");
    EXPECT_EQ(code_of(std::string(60'000, '[')), "web.too_deep");
    EXPECT_EQ(code_of(std::string(PageMessage::longest + 1, ' ')), "web.too_long");
    // As many keys as a message has room for would hold up everybody else while they are looked for one by one.
    const auto with_keys = [](int keys) {
        std::string text = R"({"type":"command","id":1,"cmd":"stop")";
        for (int key = 3; key < keys; ++key) text += ",\"" + std::to_string(key) + "\":1";
        return text + "}";
    };
    EXPECT_EQ(message_of(with_keys(64)).id, 1);
    EXPECT_EQ(code_of(with_keys(65)), "web.too_long");
    EXPECT_EQ(code_of(with_keys(7000)), "web.too_long");
    // Its id comes back where one stood.
    const auto read = read_page_message(R"({"type":"command","id":12,"cmd":"format"})");
    EXPECT_EQ(std::get<UnreadMessage>(read).id, 12);
}

TEST(PageFiles, OnlyWhatLiesInTheFolderItself) {
    auto pattern = (std::filesystem::temp_directory_path() / "taktwerk-page-XXXXXX").string();
    const std::filesystem::path folder = ::mkdtemp(pattern.data());
    EXPECT_EQ(SiteFiles::load(folder.string()).error().code, "web.no_page");
    std::ofstream(folder / "index.html") << "<p>page";
    std::ofstream(folder / "page.js") << "1";
    std::ofstream(folder / "users.yaml") << "secret";
    std::filesystem::create_directory(folder / "inner.js");
    std::filesystem::create_symlink("/etc/hostname", folder / "link.html");
    const auto site = SiteFiles::load(folder.string());
    std::filesystem::remove_all(folder);
    ASSERT_TRUE(site.ok()) << site.error().text();
    EXPECT_EQ(site->size(), 2u);
    ASSERT_NE(site->find("/"), nullptr);
    EXPECT_EQ(site->find("/")->content, "<p>page");
    EXPECT_THAT(std::string(site->find("/page.js")->type), HasSubstr("javascript"));
    for (const char* target :
         {"", "page.js", "/users.yaml", "/link.html", "/inner.js", "/../etc/passwd", "/page.js?x", "//page.js", "/%2e%2e/"})
        EXPECT_EQ(site->find(target), nullptr) << target;
}

// Nobody keeps everybody else out: with the most pages one gives way, and who may less to who may more; and nobody who has been put out puts another out.
TEST(PageSeats, GoToWhoHasFewerAndToWhoMayMore) {
    const auto at = [](int second) { return Instant{std::chrono::seconds(second)}; };
    std::vector<Seat> greedy;
    for (int i = 0; i < 16; ++i) greedy.push_back({"olga", Role::viewer, at(20 - i)});
    EXPECT_EQ(who_gives_way(greedy, "anna", Role::operates), 15u) << "the one unused the longest";
    EXPECT_EQ(who_gives_way(greedy, "otto", Role::viewer), 15u) << "whatever he may";
    EXPECT_EQ(who_gives_way(greedy, "olga", Role::viewer), std::nullopt);
    greedy[15] = {"anna", Role::operates, at(30)};
    EXPECT_EQ(who_gives_way(greedy, "olga", Role::viewer), std::nullopt) << "she has most of them already";
    EXPECT_EQ(who_gives_way(greedy, "emil", Role::engineer), 14u) << "not the one of who has one";

    std::vector<Seat> crowd;
    for (int i = 0; i < 16; ++i) crowd.push_back({"user" + std::to_string(i), i < 3 ? Role::viewer : Role::operates, at(i)});
    EXPECT_EQ(who_gives_way(crowd, "adam", Role::admin), 0u);
    EXPECT_EQ(who_gives_way(crowd, "anna", Role::operates), 0u);
    EXPECT_EQ(who_gives_way(crowd, "otto", Role::viewer), std::nullopt);
    for (int i = 0; i < 3; ++i) crowd[static_cast<std::size_t>(i)].role = Role::operates;
    EXPECT_EQ(who_gives_way(crowd, "anna", Role::operates), std::nullopt);
    EXPECT_EQ(who_gives_way({}, "anna", Role::operates), std::nullopt);
}

TEST(QuestionTurnsRule, WhoAsksMuchDelaysTheOthersByOneAnswer) {
    QuestionTurns<int> turns;
    for (int i = 0; i < 30; ++i) turns.put(1, i);
    for (int i = 0; i < 30; ++i) turns.put(2, 100 + i);
    std::vector<int> asked;
    for (auto next = turns.next(); next; next = turns.next()) asked.push_back(next->second);
    EXPECT_EQ(asked, (std::vector{0, 100, 1, 101})) << "two of each, in turn, four in all";
    turns.put(3, 200);
    EXPECT_FALSE(turns.next());
    turns.answered(1);
    EXPECT_EQ(turns.next()->second, 200) << "before the thirty that have waited longer";
    turns.answered(3);
    EXPECT_EQ(turns.next()->second, 2);
    int removed = 0;
    turns.remove([](QuestionTurns<int>::Asker asker, int) { return asker == 1; }, [&](int) { ++removed; });
    EXPECT_EQ(removed, 27);
    EXPECT_EQ(turns.waiting(), 28u);
    turns.answered(7);  // of nobody
    EXPECT_FALSE(turns.next());
}

TEST(HeldButtonsRule, OnlyWhatTheMachineTookAsPressedIsRenewed) {
    const auto message = [](const std::string& more) {
        return std::get<PageMessage>(read_page_message(R"({"type":"command","id":1,"sent_ms":1,)" + more + "}"));
    };
    const auto press = message(R"("cmd":"set_value","variable":"start","value":1,"press":true)"),
               renewal = message(R"("cmd":"set_value","variable":"start","value":1,"press":false)"),
               other = message(R"("cmd":"set_value","variable":"pace","value":1,"press":false)"),
               gone = message(R"("cmd":"set_value","variable":"start","value":0)");
    HeldButtons buttons;
    EXPECT_FALSE(buttons.is_renewal(renewal));
    buttons.taken(press);
    EXPECT_FALSE(buttons.is_renewal(press));
    EXPECT_TRUE(buttons.is_renewal(renewal));
    EXPECT_FALSE(buttons.is_renewal(other));
    buttons.taken(gone);
    EXPECT_FALSE(buttons.is_renewal(renewal));
    EXPECT_TRUE(buttons.is_renewal(message(R"("cmd":"jog","axis":"x","velocity":1)")));
}

}  // namespace
}  // namespace taktwerk::hmi::web
