// The door by itself: the service side behind it stands still (nobody calls pass_on() unless a test says so), and a stop, the end of the
// run, a jog let go and a lost client get through all the same. Real sockets, no threads, and time is what the test says.

#include "hmi_bridge/socket/door.hpp"

#include <gmock/gmock.h>
#include <sys/socket.h>
#include <unistd.h>

#include <filesystem>
#include <functional>

#include "tests/hmi_bridge/caller.hpp"
#include "tests/hmi_bridge/fake_machine.hpp"

namespace taktwerk::hmi {
namespace {

using namespace std::chrono_literals;
using test::Caller;
using test::FakeMachine;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

/// The service side: what was handed to it.
class Desk final : public RequestHandler {
public:
    void on_open(ConnectionId, const Peer&) override { ++opened; }
    void on_line(ConnectionId, std::string_view, Instant) override {}
    void on_request(ConnectionId connection, std::string_view line, Instant, const Arrival& arrival) override {
        lines.emplace_back(line);
        arrivals.push_back(arrival);
        newest = connection;
    }
    void on_close(ConnectionId) override { ++closed; }
    std::vector<std::string> lines;
    std::vector<Arrival> arrivals;
    ConnectionId newest = 0;
    int opened = 0, closed = 0;
};

class DoorTest : public testing::Test {
protected:
    DoorTest() {
        auto server = SocketServer::open(path, [this](std::string_view line) { log.emplace_back(line); });
        EXPECT_TRUE(server) << server.error().text();
        door = std::make_unique<Door>(machine, std::move(server).value(), [this](std::string_view line) { log.emplace_back(line); });
    }
    ~DoorTest() override {
        door.reset();
        std::error_code ignored;
        std::filesystem::remove_all(folder, ignored);
    }
    static std::string new_folder() {
        std::string pattern = (std::filesystem::temp_directory_path() / "taktwerk-door-XXXXXX").string();
        return ::mkdtemp(pattern.data());
    }
    Caller call() {
        Caller caller{path};
        step();
        return caller;
    }
    void step(Duration by = 1ms) { door->step(now += by); }

    std::string folder = new_folder(), path = folder + "/demo.sock";
    FakeMachine machine;
    std::vector<std::string> log;
    std::unique_ptr<Door> door;
    Desk desk;
    Instant now{1s};
};

constexpr std::string_view press = R"({"id":1,"cmd":"jog","axis":"x","velocity":20,"press":true})"
                                   "\n";
constexpr std::string_view release = R"({"id":9,"cmd":"jog","axis":"x","velocity":0})"
                                     "\n";

TEST_F(DoorTest, AStopIsRaisedAndAnsweredAlthoughNobodyServesBehindTheDoor) {
    const auto caller = call();
    caller.say("{\"id\":3,\"cmd\":\"stop\",\"axis\":\"y\"}\n{\"id\":4,\"cmd\":\"stop\"}\n{\"id\":5,\"cmd\":\"shutdown\"}\n");
    step();
    EXPECT_THAT(machine.stops, ElementsAre(1, 0xFFFF));
    EXPECT_TRUE(machine.shutdown_requested);
    EXPECT_EQ(caller.hear(), "{\"id\":3,\"ok\":true}\n{\"id\":4,\"ok\":true}\n{\"id\":5,\"ok\":true}\n");
}

// What the last key of a name hides is not lost where it is a stop: everything stops, and the line is refused behind the door.
TEST_F(DoorTest, AStopInALineWithAKeyTwiceStopsEverything) {
    const auto caller = call();
    caller.say(
        "{\"id\":1,\"cmd\":\"stop\",\"cmd\":\"state\"}\n"
        "{\"id\":2,\"cmd\":\"state\",\"cmd\":\"stop\",\"axis\":\"y\"}\n"
        "{\"id\":3,\"cmd\":\"stop\",\"axis\":\"x\",\"axis\":\"y\"}\n");
    step();
    EXPECT_THAT(machine.stops, ElementsAre(0xFFFF, 0xFFFF, 0xFFFF));
    EXPECT_THAT(caller.hear(), IsEmpty()) << "its answer is the refusal";
    door->pass_on(desk, now);
    EXPECT_THAT(desk.lines, SizeIs(3));

    caller.say("{\"id\":4,\"cmd\":\"state\",\"cmd\":\"hello\",\"stop\":1}\n{\"id\":5,\"cmd\":\"shutdown\",\"cmd\":\"state\"}\n");
    step();
    EXPECT_THAT(machine.stops, SizeIs(3)) << "nobody asked for one";
    EXPECT_FALSE(machine.shutdown_requested);
}

TEST_F(DoorTest, NoAgeNoMissingIdAndNoStrangeKeyHoldsUpAStop) {
    const auto caller = call();
    for (const char* line : {R"({"id":1,"cmd":"stop","utime":1})", R"({"id":1,"cmd":"stop","valid_ms":-1})", R"({"cmd":"stop"})",
                             R"({"id":1,"cmd":"stop","axis":"all","who":"me"})", R"({"id":"x","cmd":"stop","axis":""})"})
        caller.say(std::string(line) + "\n");
    step();
    EXPECT_THAT(machine.stops, SizeIs(5));
}

// In doubt all stop: a name that this machine does not have, and what is no name.
TEST_F(DoorTest, AStopOfAnAxisThatNobodyKnowsStopsEverythingAndSaysSo) {
    const auto caller = call();
    int stops = 0;
    for (const char* axis : {R"("turet")", "0", "null", R"(["x"])"}) {
        caller.say(std::string(R"({"id":7,"cmd":"stop","axis":)") + axis + "}\n");
        step();
        ASSERT_THAT(machine.stops, SizeIs(++stops)) << axis;
        EXPECT_EQ(machine.stops.back(), 0xFFFF) << axis;
        EXPECT_THAT(caller.hear(), AllOf(HasSubstr(R"("id":7,"ok":false)"), HasSubstr("every axis stops"))) << axis;
    }
    caller.say(R"({"id":8,"cmd":"jog","axis":"turet","velocity":0})"
               "\n");
    step();
    EXPECT_THAT(machine.stops, SizeIs(stops)) << "only a stop";
}

// A script that writes and goes: the end of the connection ends the line.
TEST_F(DoorTest, AStopWithoutItsNewlineCountsWhenTheConnectionEnds) {
    {
        const auto caller = call();
        caller.say(R"({"cmd":"stop"})");
        step();
        EXPECT_THAT(machine.stops, IsEmpty()) << "it may go on";
    }
    step();
    EXPECT_THAT(machine.stops, ElementsAre(0xFFFF));
    std::size_t stops = 1;
    for (const auto& behind : {std::string(" "), std::string("\r"), std::string("\t\r "), std::string(1, '\0')}) {
        {
            const auto caller = call();
            caller.say(R"({"cmd":"stop"})" + behind);
        }
        step();
        EXPECT_THAT(machine.stops, SizeIs(++stops)) << "behind it: " << int{behind.front()};
    }
    {
        const auto caller = call();
        caller.say(R"({"cmd":"stop")");
        step();
    }
    step();
    EXPECT_THAT(machine.stops, SizeIs(stops)) << "half a line is nobody's request";
}

TEST_F(DoorTest, AStopBehindALineThatIsTooLongCounts) {
    const auto caller = call();
    const std::string stop = "{\"id\":2,\"cmd\":\"stop\"}\n";
    for (const std::size_t size : {SocketServer::max_line + 1, SocketServer::max_line + 40'000}) {  // the second in pieces
        machine.stops.clear();
        const std::string line(size, 'x');
        ASSERT_EQ(caller.say(line.substr(0, size / 2)), size / 2);
        step();
        ASSERT_EQ(caller.say(line.substr(size / 2)), size - size / 2);
        step();
        ASSERT_EQ(caller.say("\n" + stop), 1 + stop.size());
        step();
        EXPECT_THAT(machine.stops, ElementsAre(0xFFFF));
        EXPECT_THAT(caller.hear(), AllOf(HasSubstr("request.too_long"), HasSubstr("{\"id\":2,\"ok\":true}")));
    }
    caller.say(std::string(SocketServer::max_line + 1, 'x') + stop);
    step();
    EXPECT_THAT(machine.stops, SizeIs(1)) << "its own end is no line";
}

// JSON lets any letter be written by its number; the words are the same.
TEST_F(DoorTest, AStopInEscapedWordsIsAStop) {
    const auto caller = call();
    caller.say("{\"\\u0063md\":\"\\u0073to\\u0070\"}\n");
    step();
    EXPECT_THAT(machine.stops, ElementsAre(0xFFFF));
    EXPECT_THAT(caller.hear(), HasSubstr("\"ok\":true"));
}

// Who asks for a stop must not have to write the rest of the line without a fault, nor shortly: a name in Latin-1, a number that is none, two
// requests in one line, a NUL before it, as C programs send. What it says beside that nobody can tell, so everything stops.
TEST_F(DoorTest, AStopInALineThatIsNoJsonStopsEverythingAndIsRefused) {
    const auto caller = call();
    using std::string_view_literals::operator""sv;
    std::size_t stops = 0;
    for (const auto& line : {"{\"cmd\":\"stop\",\"axis\":\"x\",\"client\":\"M\xFCller\"}"sv, "{\"cmd\" : \"stop\",\"utime\":NaN}"sv,
                             R"({"cmd":"stop","utime":1e999})"sv, R"({"cmd":"stop",})"sv, R"({"cmd":"state"}{"cmd":"stop"})"sv,
                             R"({"cmd":"stop","x":[[[[[[1]]]]]]})"sv, "\0{\"cmd\":\"stop\"}"sv, R"([{"cmd":"stop"}])"sv}) {
        caller.say(std::string(line) + "\n");
        step();
        ASSERT_THAT(machine.stops, SizeIs(++stops)) << line;
        EXPECT_EQ(machine.stops.back(), 0xFFFF) << line;
    }
    EXPECT_THAT(caller.hear(), IsEmpty()) << "the answers are the refusals behind the door";
    door->pass_on(desk, now);
    EXPECT_THAT(desk.lines, SizeIs(stops));
    for (const char* line : {R"({"cmd":"state","x":NaN})", R"({"cmd","stop"})", R"({"cmd":"stopped",})", R"({"stop":1,})"})
        caller.say(std::string(line) + "\n");
    step();
    EXPECT_THAT(machine.stops, SizeIs(stops)) << "nobody asked for one";
}

// hmi_bridge/README.md: a line has up to 64 KiB, a stop needs no id and waits for nobody.
TEST_F(DoorTest, NoLengthHoldsUpAStopOrAShutdown) {
    const auto caller = call();
    for (const std::size_t size : {1'000, 2'000, 60'000}) {
        machine.stops.clear();
        caller.say(R"({"cmd":"stop","axis":"y","n":")" + std::string(size, 'x') + "\"}\n");
        step();
        EXPECT_THAT(machine.stops, ElementsAre(1)) << size;
        EXPECT_THAT(caller.hear(), HasSubstr("\"ok\":true")) << size;
    }
    caller.say(R"({"cmd":"shutdown","n":")" + std::string(2'000, 'x') + "\"}\n");
    step();
    EXPECT_TRUE(machine.shutdown_requested);
}

TEST_F(DoorTest, AStopBehindItsClientsOwnFloodActsInTheStepThatReadsIt) {
    const auto caller = call();
    std::string flood;
    for (int i = 1; i <= 3000; ++i) flood += "{\"id\":" + std::to_string(i) + ",\"cmd\":\"acknowledge\"}\n";
    flood += "{\"id\":3001,\"cmd\":\"stop\"}\n";
    ASSERT_EQ(caller.say(flood), flood.size()) << "all of it is in the kernel";
    step();
    EXPECT_THAT(machine.stops, SizeIs(1));
    EXPECT_THAT(caller.hear(), HasSubstr("command.queue_full")) << "what did not fit was refused to who sent it";
}

TEST_F(DoorTest, EightClientsThatFloodInEveryWayDoNotHoldUpAStopOfTheNinth) {
    std::vector<Caller> rude;
    const std::string long_line = std::string(SocketServer::max_line - 10, 'x') + "\n";
    const std::string jogs = R"({"id":1,"cmd":"jog","axis":"x","velocity":20})"
                             "\n";
    const std::string words = R"({"id":1,"cmd":"acknowledge"})"
                              "\n",
                      half = R"({"id":1,"cmd":"st)", stops = "{\"stop\"\n";
    const std::vector<std::function<void(const Caller&)>> ways{
        [&](const Caller& c) {
            while (c.say(words) > 0) {}
        },
        [&](const Caller& c) {
            while (c.say(jogs) > 0) {}
        },
        [&](const Caller& c) {
            while (c.say(long_line) > 0) {}
        },
        [&](const Caller& c) { c.say(half); },
        [&](const Caller& c) {
            while (c.say("\x01\xFF\n") > 0) {}
        },
        [&](const Caller& c) {
            while (c.say(stops) > 0) {}
        },
        [&](const Caller& c) {
            while (c.say("{\"cmd\":\"state\"}\n") > 0) {}
        },
        [](const Caller&) {},
    };
    ASSERT_EQ(ways.size(), SocketServer::max_connections);
    for (std::size_t i = 0; i < ways.size(); ++i) rude.push_back(call());
    for (int round = 0; round < 5; ++round) {
        for (std::size_t i = 0; i < ways.size(); ++i) ways[i](rude[i]);
        step();
    }
    for (std::size_t i = 0; i < ways.size(); ++i) ways[i](rude[i]);
    const Caller ninth{path};
    ninth.say("{\"id\":1,\"cmd\":\"stop\"}\n");
    step();
    EXPECT_THAT(machine.stops, SizeIs(1)) << "in the very step in which it connects";
    EXPECT_THAT(ninth.hear(), HasSubstr("{\"id\":1,\"ok\":true}"));
}

TEST_F(DoorTest, ClientsThatNeverReadHoldUpNobody) {
    const auto deaf = call();
    for (int i = 0; i < 2000; ++i) {
        deaf.say("{\"id\":1,\"cmd\":\"stop\"}\n");
        step();
    }
    const auto before = machine.stops.size();
    const auto good = call();
    good.say("{\"id\":1,\"cmd\":\"stop\"}\n");
    step();
    EXPECT_EQ(machine.stops.size(), before + 1);
    EXPECT_THAT(good.hear(), HasSubstr("\"ok\":true"));
}

TEST_F(DoorTest, AnIdleClientGivesItsPlaceAndBusyOnesLeaveAReserve) {
    std::vector<Caller> idle;
    for (std::size_t i = 0; i < SocketServer::max_connections; ++i) idle.push_back(call());
    // All have spoken just now: the next one may stop and shut down, and of those in reserve the oldest goes first.
    std::vector<Caller> more;
    for (std::size_t i = 0; i < SocketServer::reserve + 2; ++i) {
        more.push_back(call());
        more.back().say("{\"cmd\":\"hello\"}\n");
        step();
        EXPECT_THAT(more.back().hear(), HasSubstr("socket.too_many_clients"));
    }
    EXPECT_THAT(more[0].hear(), HasSubstr("went to another"));
    EXPECT_TRUE(more[0].cut_off());
    EXPECT_FALSE(more.back().cut_off());
    more.back().say("{\"id\":1,\"cmd\":\"stop\"}\n");
    step();
    EXPECT_THAT(machine.stops, SizeIs(1));

    // Later: seven go on talking, one does not; its place goes to a full client.
    step(SocketServer::idle);
    for (std::size_t i = 1; i < idle.size(); ++i) idle[i].say("{\"cmd\":\"hello\"}\n");
    step();
    const auto late = call();
    EXPECT_THAT(idle[0].hear(), HasSubstr("socket.idle"));
    EXPECT_TRUE(idle[0].cut_off());
    late.say("{\"id\":1,\"cmd\":\"acknowledge\"}\n");
    step();
    door->pass_on(desk, now);
    EXPECT_THAT(desk.lines, testing::Contains(HasSubstr("acknowledge")));
}

TEST_F(DoorTest, WhoHoldsAJogIsNotSentAwayForAnother) {
    auto holder = call();
    holder.say(press);
    step();
    std::vector<Caller> idle;
    for (std::size_t i = 1; i < SocketServer::max_connections; ++i) idle.push_back(call());
    step(SocketServer::idle);
    const auto next = call();
    EXPECT_FALSE(holder.cut_off());
    EXPECT_THAT(idle[0].hear(), HasSubstr("socket.idle"));
    EXPECT_TRUE(idle[0].cut_off());
}

TEST_F(DoorTest, AJogLetGoAndALostHolderAreLevelsAlthoughNobodyServes) {
    auto caller = call();
    caller.say(press);
    step();
    caller.say(release);
    step();
    EXPECT_THAT(machine.releases, ElementsAre(0));
    caller.say(press);
    step();
    caller.hang_up();
    step();
    EXPECT_THAT(machine.releases, ElementsAre(0, 0));
}

TEST_F(DoorTest, AMeasurementIsHeldAsAJogIs) {
    auto caller = call();
    caller.say(R"({"id":1,"cmd":"measure","axis":"x","kind":"step","velocity":0,"press":true})"
               "\n");
    step(500ms);
    caller.say(R"({"id":2,"cmd":"measure","axis":"x"})"
               "\n");
    step(700ms);  // the renewal keeps it held for a second more
    caller.hang_up();
    step();
    EXPECT_THAT(machine.releases, ElementsAre(0));
}

TEST_F(DoorTest, WhoHoldsNothingReleasesNothing) {
    auto caller = call();
    caller.say(release);
    step();
    caller.say(press);
    step();
    door->pass_on(desk, now);
    door->answer(desk.newest, R"({"id":1,"ok":false})", "1");  // somebody else jogs it
    step();
    caller.say(release);
    step();
    caller.hang_up();
    step();
    EXPECT_THAT(machine.releases, IsEmpty());
}

TEST_F(DoorTest, ALineKnowsWhichStopsCameBeforeItAndHowLongItMayHaveWaited) {
    const auto caller = call();
    caller.say("{\"id\":1,\"cmd\":\"home\",\"axis\":\"x\"}\n{\"id\":2,\"cmd\":\"stop\"}\n{\"id\":3,\"cmd\":\"home\",\"axis\":\"x\"}\n");
    step();
    const auto looked = now;
    caller.say("{\"id\":4,\"cmd\":\"home\",\"axis\":\"x\"}\n");
    step(20s);  // the whole process was held
    door->pass_on(desk, now);
    ASSERT_THAT(desk.arrivals, SizeIs(3));
    EXPECT_EQ(desk.arrivals[0].after, 0u);
    EXPECT_EQ(desk.arrivals[1].after, 1u);
    EXPECT_EQ(desk.arrivals[0].at, looked);
    EXPECT_EQ(desk.arrivals[2].at, looked) << "as old as the last look, for all anybody knows";
}

TEST_F(DoorTest, ALineOfAClosedClientIsCarriedOutAtOnceOrNotAtAll) {
    for (const auto& [waits, carried_out] : {std::pair{Duration{10ms}, 1u}, {Duration{20s}, 0u}}) {
        desk = {};
        auto caller = call();
        caller.say("{\"id\":1,\"cmd\":\"move\",\"axis\":\"x\",\"position\":1,\"velocity\":1}\n");
        step();
        caller.hang_up();
        step();
        door->pass_on(desk, now += waits);
        EXPECT_THAT(desk.lines, SizeIs(carried_out));
        EXPECT_EQ(desk.closed, 1);
    }
}

TEST_F(DoorTest, WhenTheCycleStandsAStopAndAShutdownSaySo) {
    const auto caller = call();
    machine.takes_levels = false;
    machine.stuck_words = "task 'main' of program 'cell' does not return";
    caller.say("{\"id\":1,\"cmd\":\"stop\"}\n{\"id\":2,\"cmd\":\"shutdown\"}\n");
    step();
    EXPECT_EQ(caller.hear(), "");
    step(Door::patience);
    const auto heard = caller.hear();
    EXPECT_THAT(heard, HasSubstr(R"({"id":1,"ok":false,"error":{"code":"command.no_answer")"));
    EXPECT_THAT(heard, HasSubstr(R"({"id":2,"ok":false)"));
    EXPECT_THAT(heard, HasSubstr("'main' of program 'cell'"));
}

constexpr std::string_view press_group = R"({"id":1,"cmd":"group_jog","group":"table","direction":"x+","velocity":1,"press":true})"
                                         "\n";

// The hand on a group is one on each of its axes: a release and a lost client are levels of all of them, although nobody serves behind the door; somebody
// else's release is none.
TEST_F(DoorTest, AGroupThatIsLetGoOrLostIsALevelOfEachOfItsAxes) {
    const auto holder = call();
    const auto other = call();
    holder.say(press_group);
    step();
    other.say("{\"id\":9,\"cmd\":\"group_jog\",\"group\":\"table\",\"velocity\":0}\n");
    step();
    EXPECT_THAT(machine.releases, IsEmpty());
    holder.say("{\"id\":9,\"cmd\":\"group_jog\",\"group\":\"table\",\"velocity\":0}\n");
    step();
    EXPECT_THAT(machine.releases, ElementsAre(0, 1));
    door->pass_on(desk, now);
    ASSERT_THAT(desk.arrivals, SizeIs(3));
    // A connection's lines stay together.
    EXPECT_TRUE(desk.arrivals[1].level_raised);
    EXPECT_FALSE(desk.arrivals[2].level_raised) << "the other one has raised nothing";
}

// A press that is refused beside one that is held: that one is held still, and its release is a level.
TEST_F(DoorTest, ARefusedSecondPressLeavesTheFirstHeld) {
    const auto holder = call();
    holder.say(press_group);
    step();
    holder.say("{\"id\":2,\"cmd\":\"jog\",\"axis\":\"x\",\"velocity\":5,\"press\":true}\n");
    step();
    door->pass_on(desk, now);
    ASSERT_THAT(desk.arrivals, SizeIs(2));
    door->answer(desk.newest, R"({"id":2,"ok":false})", "2");
    step();
    holder.say("{\"id\":9,\"cmd\":\"group_jog\",\"group\":\"table\",\"velocity\":0}\n");
    step();
    EXPECT_THAT(machine.releases, ElementsAre(0, 1));
}

TEST_F(DoorTest, WhoIsLostWhileItHoldsAGroupLetsGoOfAllOfIt) {
    auto holder = call();
    holder.say(press_group);
    step();
    holder.hang_up();
    step();
    step();
    EXPECT_THAT(machine.releases, ElementsAre(0, 1));
}

}  // namespace
}  // namespace taktwerk::hmi
