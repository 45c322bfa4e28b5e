// Strangers, slow readers and long answers before the page's server: what is dropped, what flows on, and that a stop passes everything.

#include <sys/un.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <deque>

#include "tests/hmi_bridge/web/served_site.hpp"

namespace taktwerk::hmi::web {
namespace {

using namespace std::chrono_literals;

class ServerLimits : public ServedSite {
protected:
    /// ms that a stop of `page` takes to the machine; -1: it never came.
    std::int64_t stop_takes(PageClient& page) {
        const auto before = machine.asked("stop").size();
        const auto at = PageClock::now();
        page.command({{"cmd", "stop"}});
        while (PageClock::now() - at < 5s) {
            if (machine.asked("stop").size() > before)
                return std::chrono::duration_cast<std::chrono::milliseconds>(PageClock::now() - at).count();
            ::usleep(1000);
        }
        return -1;
    }
};

TEST_F(ServerLimits, AnAnswerOfFourMebibytesPassesUnread) {
    serve();
    PageClient page;
    ASSERT_TRUE(page.open(port));
    ASSERT_TRUE(shows_machine(page));
    machine.long_answer = 4 * 1024 * 1024 - 4096;
    const auto answer = page.ask({{"cmd", "scope_read"}, {"signals", {"x.set_position"}}}, 60s);
    EXPECT_EQ(answer["ok"], true);
    EXPECT_EQ(answer["data"].get<std::string>().size(), 4u * 1024 * 1024 - 4096);
}

// Eight such answers are under way to a page that takes none of them: its stop and its jog are at the machine all the same.
TEST_F(ServerLimits, LongAnswersDelayNeitherAStopNorAJog) {
    serve();
    PageClient page;
    ASSERT_TRUE(page.open(port, {}, 16 * 1024));
    ASSERT_TRUE(shows_machine(page));
    machine.long_answer = 1024 * 1024;
    for (int i = 0; i < 8; ++i) page.command({{"cmd", "scope_read"}});
    EXPECT_LT(stop_takes(page), 500);
    EXPECT_GE(machine.asked("stop").size(), 1u);
    page.command({{"cmd", "jog"}, {"axis", "x"}, {"velocity", 5}, {"press", true}});
    for (int tries = 0; tries < 500 && machine.asked("jog").empty(); ++tries) ::usleep(1000);
    ASSERT_EQ(machine.asked("jog").size(), 1u);
    EXPECT_NE(machine.asked("jog")[0].connection, machine.asked("scope_read").at(0).connection);
}

TEST_F(ServerLimits, WhoTakesNothingIsDroppedAndNobodyElseFeelsIt) {
    serve();
    PageClient slow, quick;
    ASSERT_TRUE(slow.open(port, {}, 4096));
    ASSERT_TRUE(quick.open(port));
    ASSERT_TRUE(shows_machine(slow));
    ASSERT_TRUE(shows_machine(quick));
    machine.long_answer = 3 * 1024 * 1024;
    slow.command({{"cmd", "scope_read"}});
    for (const auto until = PageClock::now() + 4s; PageClock::now() < until;) ASSERT_FALSE(quick.next("state", 1s).is_null());
    // What the kernel and the socket still held comes; then the end, before the answer is whole.
    EXPECT_TRUE(slow.ask({{"cmd", "hello"}}, 3s).is_null());
    EXPECT_TRUE(slow.is_closed(3s));
}

TEST_F(ServerLimits, OfValuesASlowPageGetsTheNewest) {
    serve();
    PageClient page;
    ASSERT_TRUE(page.open(port));
    ASSERT_TRUE(shows_machine(page));
    const auto first = page.next("state")["state"]["cycle"].get<std::int64_t>();
    ::usleep(500'000);  // ten states: the kernel holds them, and the page reads them all
    std::int64_t last = first;
    for (PageJson state = page.next("state", 20ms); !state.is_null(); state = page.next("state", 20ms)) {
        EXPECT_GT(state["state"]["cycle"].get<std::int64_t>(), last);
        last = state["state"]["cycle"].get<std::int64_t>();
        if (last > first + 8) break;
    }
    EXPECT_GT(last, first + 2);
}

TEST_F(ServerLimits, IdleConnectionsKeepNobodyOut) {
    serve();
    std::deque<TcpEnd> idle;
    for (std::size_t i = 0; i < 2 * WebServer::most_connections; ++i) {
        idle.emplace_back();
        ASSERT_TRUE(idle.back().open(port)) << i;
        if (i % 2 == 0) idle.back().write("GET / HT");
    }
    EXPECT_EQ(http_request(port, "GET /").status, 200);
    PageClient page;
    EXPECT_TRUE(page.open(port));
    EXPECT_FALSE(page.next("state").is_null());
}

TEST_F(ServerLimits, TheSeventeenthPageIsToldThatTheyAreTooMany) {
    serve();
    std::deque<PageClient> pages;
    for (std::size_t i = 0; i < WebServer::most_pages; ++i) {
        pages.emplace_back();
        ASSERT_TRUE(pages.back().open(port)) << i;
    }
    PageClient another;
    EXPECT_FALSE(another.open(port));
    EXPECT_EQ(another.status(), 503);
    pages.pop_front();
    bool opened = false;
    for (int tries = 0; tries < 100 && !opened; ++tries) {
        opened = another.open(port);
        if (!opened) ::usleep(20'000);
    }
    EXPECT_TRUE(opened);
}

TEST_F(ServerLimits, AViewerWithSixteenPagesKeepsNoOperatorOut) {
    ServerOptions options;
    options.users = users_file();
    serve(options);
    const auto olga = cookie_of("olga");
    std::deque<PageClient> pages;
    for (std::size_t i = 0; i < WebServer::most_pages; ++i) {
        pages.emplace_back();
        ASSERT_TRUE(pages.back().open(port, olga)) << i;
        ASSERT_FALSE(pages.back().next("hello").is_null());
    }
    PageClient operators, another;
    ASSERT_TRUE(operators.open(port, cookie_of("anna")));
    ASSERT_TRUE(shows_machine(operators));
    EXPECT_EQ(operators.ask({{"cmd", "mode"}, {"mode", "manual"}})["ok"], true);
    EXPECT_TRUE(pages.front().is_closed(3s)) << "the one that had been there the longest";
    EXPECT_FALSE(another.open(port, olga));
    EXPECT_EQ(another.status(), 503);
    EXPECT_EQ(operators.ask({{"cmd", "mode"}, {"mode", "manual"}})["ok"], true) << "who was put out puts nobody out";
}

// Ten pages that ask for what needs no place, and arm triggers, which do: an operator's command finds one all the same.
TEST_F(ServerLimits, ViewersTakeNoOperatorsPlaceAtTheMachine) {
    ServerOptions options;
    options.users = users_file();
    serve(options);
    const auto olga = cookie_of("olga");
    std::deque<PageClient> pages;
    int armed = 0;
    for (int i = 0; i < 10; ++i) {
        auto& page = pages.emplace_back();
        ASSERT_TRUE(page.open(port, olga));
        ASSERT_TRUE(shows_machine(page));
        for (const char* cmd : {"drive_read", "state", "alarms", "measure_plan", "hello"})
            EXPECT_EQ(page.ask({{"cmd", cmd}})["ok"], true) << cmd;
        const auto answer = page.ask({{"cmd", "scope_arm"}});
        if (answer["ok"] == true) ++armed;
        else EXPECT_EQ(answer["error"]["code"], "web.busy");
    }
    EXPECT_EQ(armed, 2);
    EXPECT_EQ(machine.connections(), 4u) << "the server's, that of all questions, two triggers";
    PageClient operators;
    ASSERT_TRUE(operators.open(port, cookie_of("anna")));
    ASSERT_TRUE(shows_machine(operators));
    EXPECT_EQ(operators.ask({{"cmd", "scope_arm"}})["ok"], true);
    EXPECT_EQ(operators.ask({{"cmd", "take_control"}, {"axis", "x"}})["ok"], true);
    pages.pop_front();
    for (int tries = 0; tries < 200 && machine.connections() > 4; ++tries) ::usleep(10'000);
    EXPECT_EQ(pages.back().ask({{"cmd", "scope_arm"}})["ok"], true) << "in the place of who has gone";
}

// The machine has eight places, and others have them: a stop of a page whose own connection is refused is carried out, and the refusal has the machine's words.
TEST_F(ServerLimits, AStopNeedsNoPlaceAndWhatDoesIsToldWhy) {
    serve();
    PageClient page;
    ASSERT_TRUE(page.open(port));
    ASSERT_TRUE(shows_machine(page));
    std::vector<int> others;
    for (int i = 0; i < 7; ++i) {
        others.push_back(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
        sockaddr_un to{};
        to.sun_family = AF_UNIX;
        machine.path().copy(to.sun_path, sizeof to.sun_path - 1);
        ASSERT_EQ(::connect(others.back(), reinterpret_cast<const sockaddr*>(&to), sizeof to), 0);
    }
    for (int tries = 0; tries < 200 && machine.connections() < 8; ++tries) ::usleep(5'000);
    ASSERT_EQ(machine.connections(), 8u);
    const auto refused = page.ask({{"cmd", "mode"}, {"mode", "manual"}});
    ASSERT_EQ(refused.value("ok", true), false) << refused.dump();
    EXPECT_EQ(refused["error"]["code"], "socket.too_many_clients");
    page.command({{"cmd", "mode"}, {"mode", "manual"}});
    EXPECT_EQ(page.ask({{"cmd", "stop"}})["ok"], true);
    EXPECT_GE(machine.asked("stop").size(), 1u);
    for (const int other : others) ::close(other);
}

TEST_F(ServerLimits, StrangersKeepNoUserOut) {
    ServerOptions options;
    options.users = users_file();
    serve(options);
    std::deque<PageClient> strangers;
    for (std::size_t i = 0; i < 2 * WebServer::most_strangers; ++i) {
        strangers.emplace_back();
        ASSERT_TRUE(strangers.back().open(port)) << i;
    }
    EXPECT_TRUE(strangers.front().is_closed(3s)) << "the oldest gave way";
    PageClient page;
    ASSERT_TRUE(page.open(port, cookie_of("olga")));
    EXPECT_EQ(page.next("hello")["user"], "olga");
}

// Nobody pushes what others did out of the audit: what is refused is bounded in length and number, and counted.
TEST_F(ServerLimits, RefusalsDoNotFillTheAudit) {
    ServerOptions options;
    options.users = users_file();
    serve(options);
    PageClient stranger, viewer, engineer;
    ASSERT_TRUE(stranger.open(port));
    ASSERT_TRUE(viewer.open(port, cookie_of("olga")));
    ASSERT_TRUE(engineer.open(port, cookie_of("emil")));
    ASSERT_TRUE(shows_machine(viewer));
    ASSERT_TRUE(shows_machine(engineer));
    for (auto* page : {&stranger, &viewer})
        for (int i = 0; i < 100; ++i)
            EXPECT_EQ(page->ask({{"cmd", "set_output"}, {"output", std::string(20'000, 'A')}, {"value", 1}})["ok"], false);
    for (int i = 0; i < 60; ++i) (void)log_in("nobody" + std::to_string(i), "12345678");
    for (int i = 0; i < 60; ++i)
        EXPECT_EQ(engineer.ask({{"cmd", "home"}, {"axis", "x"}})["ok"], false) << "by the machine: somebody's deed";
    end();
    std::map<std::string, std::size_t> written, counted;
    std::size_t longest = 0;
    for (const auto& line : audit()) {
        longest = std::max(longest, line.dump().size());
        if (line.contains("times")) counted[line["who"]] += line["times"].get<std::size_t>();
        else if (line.value("event", "") == "login") ++written[line["ok"] == true ? "in" : "login"];
        else ++written[line["user"] == "" ? "stranger" : "user " + line["user"].get<std::string>()];
    }
    EXPECT_LT(longest, 2000u);
    EXPECT_EQ(written["user emil"], 60u);
    for (const char* who : {"stranger", "user olga"}) {
        EXPECT_GE(written[who], 40u) << who;
        EXPECT_LT(written[who], 70u) << who << ": forty, and one each two seconds";
        EXPECT_EQ(written[who] + counted[who], 100u) << who;
    }
    EXPECT_GE(written["login"], 40u);
    EXPECT_EQ(written["login"] + counted["login"], 60u);
}

TEST_F(ServerLimits, HostileMessagesAreAnsweredAndOversizeOnesEndThePage) {
    serve();
    PageClient page;
    ASSERT_TRUE(page.open(port));
    ASSERT_TRUE(shows_machine(page));
    for (const std::string& text :
         {std::string("{"), std::string("null"), std::string(R"({"type":"command","id":-1,"cmd":"stop"})"), std::string(R"({"type":"x"})"),
          std::string(R"({"type":"command","id":1,"id":2,"cmd":"stop"})"), std::string(60'000, '[')}) {
        ASSERT_TRUE(page.say_text(text));
        EXPECT_FALSE(page.next("error").is_null()) << text.substr(0, 60);
    }
    EXPECT_EQ(page.ask({{"cmd", "stop"}})["ok"], true) << "the connection stayed";
    page.say_text("\"" + std::string(PageMessage::longest, 'x') + "\"");
    EXPECT_TRUE(page.is_closed(3s));

    PageClient binary;
    ASSERT_TRUE(binary.open(port));
    binary.say_bytes(PageClient::frame(0x82, "{}"));
    EXPECT_TRUE(binary.is_closed(3s));
    PageClient no_text;  // RFC 6455 section 8.1: a text that is no UTF-8 fails the connection
    ASSERT_TRUE(no_text.open(port));
    no_text.say_text("\"\xff\xfe\"");
    EXPECT_TRUE(no_text.is_closed(3s));
    PageClient unmasked;
    ASSERT_TRUE(unmasked.open(port));
    unmasked.say_bytes(std::string("\x81\x02{}"));
    EXPECT_TRUE(unmasked.is_closed(3s));
    PageClient flood;
    ASSERT_TRUE(flood.open(port));
    for (int i = 0; i < 1000; ++i)
        if (!flood.say_text("{}")) break;
    EXPECT_TRUE(flood.is_closed(3s));
}

TEST_F(ServerLimits, AViewersStopNeedsNoPlaceAtTheMachine) {
    ServerOptions options;
    options.role = Role::viewer;
    serve(options);
    PageClient page;
    ASSERT_TRUE(page.open(port));
    ASSERT_TRUE(shows_machine(page));
    EXPECT_EQ(page.ask({{"cmd", "jog"}, {"axis", "x"}, {"velocity", 5}, {"press", true}})["error"]["code"], "web.role");
    EXPECT_EQ(machine.connections(), 1u);
    EXPECT_EQ(page.ask({{"cmd", "stop"}})["ok"], true);
    EXPECT_EQ(page.ask({{"cmd", "stop"}, {"sent_ms", 0.0}})["ok"], true) << "an old stop is a stop";
    EXPECT_EQ(machine.connections(), 1u);
    ASSERT_EQ(machine.asked("stop").size(), 2u);
}

// The machine answers nothing: thirty-two commands wait, the next is refused, a stop and a jog let go are not.
TEST_F(ServerLimits, ABusyPageMayStopAndLetGo) {
    serve();
    PageClient page;
    ASSERT_TRUE(page.open(port));
    ASSERT_TRUE(shows_machine(page));
    machine.silent = true;
    for (int i = 0; i < 32; ++i) page.command({{"cmd", "mode"}, {"mode", "manual"}});
    EXPECT_EQ(page.ask({{"cmd", "mode"}, {"mode", "manual"}}, 1s)["error"]["code"], "web.busy");
    EXPECT_GE(stop_takes(page), 0);
    page.command({{"cmd", "jog"}, {"axis", "x"}, {"velocity", 0}});
    for (int tries = 0; tries < 500 && machine.asked("jog").empty(); ++tries) ::usleep(1000);
    EXPECT_EQ(machine.asked("jog").size(), 1u);
}

TEST_F(ServerLimits, WhatANetworkHeldBackIsNotCarriedOut) {
    serve();
    PageClient page;
    ASSERT_TRUE(page.open(port));
    ASSERT_TRUE(shows_machine(page));
    const auto at = PageClient::now_ms();
    EXPECT_EQ(page.ask({{"cmd", "jog"}, {"axis", "x"}, {"velocity", 5}, {"press", true}, {"sent_ms", at}})["ok"], true);
    ::usleep(600'000);  // the stall; then everything at once, as it was sent
    for (int i = 1; i <= 6; ++i)
        EXPECT_EQ(page.ask({{"cmd", "jog"}, {"axis", "x"}, {"velocity", 5}, {"sent_ms", at + 50 * i}})["error"]["code"], "web.too_old")
            << i;
    EXPECT_EQ(page.ask({{"cmd", "move"}, {"axis", "x"}, {"position", 5}, {"velocity", 5}, {"sent_ms", at + 300}})["error"]["code"],
              "web.too_old");
    EXPECT_TRUE(page.say({{"type", "clock"}, {"sent_ms", PageClient::now_ms()}})) << "no answer, and nothing is asked of the machine";
    const auto jogs = machine.asked("jog");
    ASSERT_EQ(jogs.size(), 2u) << "the press, and the server's own word that it is let go";
    EXPECT_EQ(jogs[1].request["velocity"], 0);
    EXPECT_TRUE(machine.asked("move").empty());
}

TEST_F(ServerLimits, TwoMachinesAndNoCommandForTheOneThatIsNotShown) {
    SocketMachine other{"press", (folder_ / "press.sock").string()};
    ServerOptions options;
    options.machines = {machine.path(), other.path()};
    serve(options);
    PageClient page;
    ASSERT_TRUE(page.open(port));
    const auto both = page.next(
        [](const PageJson& one) { return one.value("type", "") == "hello" && one["machines"].size() == 2 && one["machine"] == "demo"; },
        5s);
    ASSERT_FALSE(both.is_null());
    EXPECT_EQ(page.ask({{"cmd", "mode"}, {"mode", "manual"}, {"machine", "press"}})["error"]["code"], "web.other_machine");
    EXPECT_EQ(page.ask({{"cmd", "stop"}, {"machine", "press"}})["ok"], true) << "any machine may be stopped from any page";
    EXPECT_EQ(other.asked("stop").size(), 1u);
    page.say({{"type", "watch"}, {"machine", "press"}});
    EXPECT_FALSE(
        page.next([](const PageJson& one) { return one.value("type", "") == "state" && one["machine"] == "press"; }, 5s).is_null());
    EXPECT_EQ(page.ask({{"cmd", "mode"}, {"mode", "manual"}, {"machine", "press"}})["ok"], true);
    EXPECT_TRUE(machine.asked("mode").empty());
}

TEST_F(ServerLimits, AMachineThatStandsStillOrGoesIsToldAsStaleAndComesBack) {
    serve();
    PageClient page;
    ASSERT_TRUE(page.open(port));
    ASSERT_FALSE(page.next("state").is_null());
    machine.stands = true;
    const auto stale = page.next("stale", 3s);
    EXPECT_EQ(stale["why"], "the machine's cycle does not advance");
    EXPECT_GE(stale["age_ms"], 500);
    machine.stands = false;
    EXPECT_FALSE(page.next("state", 3s).is_null());
    machine.stop();
    const auto gone =
        page.next([](const PageJson& one) { return one.value("type", "") == "hello" && one["machines"][0]["online"] == false; }, 5s);
    EXPECT_FALSE(gone.is_null());
    machine.start();
    EXPECT_FALSE(page.next([](const PageJson& one) { return one.value("type", "") == "hello" && one["machines"][0]["online"] == true; }, 5s)
                     .is_null());
    EXPECT_FALSE(page.next("state", 3s).is_null());
}

}  // namespace
}  // namespace taktwerk::hmi::web
