// Parameters of drives while the machine runs: who may, when, what it costs the EEPROM, what the log says. The profile's rows are those
// of the SV33-E (7.2: P05.10, P05.13) with some made up beside them.

#include "hmi_bridge/gateway/drive_requests.hpp"

#include <gmock/gmock.h>

#include <map>

#include <nlohmann/json.hpp>

#include "hmi_bridge/socket/json_requests.hpp"
#include "tests/hmi_bridge/fake_machine.hpp"

namespace taktwerk::hmi {
namespace {

using namespace std::chrono_literals;
using axes::ParameterAddress;
using test::FakeMachine;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// Answers each request in the step after it, unless it is silent; keeps 16-bit words by address.
class FakePort final : public axes::DrivePort {
public:
    const axes::DriveCapabilities& capabilities() const noexcept override { return caps; }
    const axes::DriveFeedback& decode(Instant) noexcept override { return feedback_; }
    void encode(const axes::DriveCommand&, Instant) noexcept override {}
    Instant setpoint_effective(Instant at) const noexcept override { return at; }
    axes::DriveAlarm alarm() const noexcept override { return {}; }
    axes::ServiceTicket read_parameter(ParameterAddress address) override {
        const auto word = words[key(address)];
        return open({static_cast<std::byte>(word & 0xFF), static_cast<std::byte>(word >> 8)});
    }
    axes::ServiceTicket write_parameter(ParameterAddress address, std::vector<std::byte> value) override {
        if (key(address) == mapped) return 0;
        written.push_back(key(address));
        if (value.size() == 2)
            words[key(address)] = static_cast<std::uint16_t>(std::to_integer<int>(value[0]) | std::to_integer<int>(value[1]) << 8);
        return open({});
    }
    axes::ServiceTicket start_service(axes::DriveService service) override {
        services.push_back(service);
        return open({});
    }
    std::optional<Result<axes::ServiceAnswer>> service_answer(axes::ServiceTicket ticket) override {
        if (silent) return std::nullopt;
        if (refuses) return Result<axes::ServiceAnswer>{Error{"sdo.abort", "x_drive", "0x06090030 value range exceeded", ""}};
        return Result<axes::ServiceAnswer>{answers_.at(ticket)};
    }
    static std::uint32_t key(ParameterAddress address) { return static_cast<std::uint32_t>(address.index) << 8 | address.sub; }

    axes::DriveCapabilities caps;
    std::map<std::uint32_t, std::uint16_t> words;
    std::vector<std::uint32_t> written;
    std::vector<axes::DriveService> services;
    std::uint32_t mapped = 0;
    bool silent = false, refuses = false;

private:
    axes::ServiceTicket open(axes::ServiceAnswer answer) {
        answers_[++last_] = std::move(answer);
        return last_;
    }
    std::map<axes::ServiceTicket, axes::ServiceAnswer> answers_;
    axes::ServiceTicket last_ = 0;
    axes::DriveFeedback feedback_;
};

class DriveRequestsTest : public ::testing::Test {
protected:
    DriveRequestsTest() {
        profile.name = "sv33-e";
        profile.storage.way = axes::ParameterStorage::each_write;
        profile.storage.switched_by = {0x2005, 0x0B};
        add({0x2005, 0x0B}, "P05.10", "store writes");
        auto& brake = add({0x2005, 0x0E}, "P05.13", "brake release");
        brake.unit = "ms";
        brake.maximum = 500;
        add({0x2006, 0x01}, "P06.00", "only while off").change = axes::ParameterChange::disabled;
        add({0x2014, 0x06}, "P20.05", "clear turns").action = true;
        add({0x603F, 0x00}, "", "error code").change = axes::ParameterChange::never;
        machine.drives = {{&port, &profile}, {&second, &profile}};
        machine.its_layout.axes[0].drive = machine.its_layout.axes[1].drive = "x_drive";  // a drive of two axes
        machine.snapshot.mode = runtime::Mode::manual;
        for (auto& axis : machine.snapshot.axes) axis.owner = axes::Owner::operator_panel, axis.drive_state = axes::PowerState::disabled;
        port.words[FakePort::key({0x2005, 0x0E})] = 250;
    }
    axes::DriveParameter& add(ParameterAddress address, const char* number, const char* name) {
        auto& row = profile.parameters.emplace_back();
        row.address = address;
        row.parameter = number;
        row.name = name;
        return row;
    }
    DriveAnswer ask(DriveRequestKind kind, std::string parameter = "", std::string value = "", bool store = false) {
        requests.handle({kind, "x", std::move(parameter), std::move(value), store, "process 7", 1, "5"}, &machine.snapshot, now);
        now += 5ms;
        requests.step(now);
        const auto answer = requests.next_answer();
        EXPECT_TRUE(answer) << "each request has one answer";
        EXPECT_FALSE(requests.next_answer());
        return answer.value_or(DriveAnswer{});
    }
    std::string refusal(DriveRequestKind kind, std::string parameter = "", std::string value = "", bool store = false) {
        const auto answer = ask(kind, std::move(parameter), std::move(value), store);
        return answer.error ? answer.error->code : "accepted";
    }
    static constexpr auto read = DriveRequestKind::read, write = DriveRequestKind::write, store_all = DriveRequestKind::store;

    FakeMachine machine;
    FakePort port, second;
    axes::DriveProfile profile;
    std::vector<std::string> log;
    DriveRequests requests{machine, [this](std::string_view line) { log.emplace_back(line); }};
    Instant now{10s};
};

TEST_F(DriveRequestsTest, ReadingIsEverybodysInEveryMode) {
    machine.snapshot.mode = runtime::Mode::automatic;
    machine.snapshot.axes[0].owner = axes::Owner::program;
    const auto answer = ask(read, "p05.13");
    ASSERT_FALSE(answer.error) << answer.error->text();
    EXPECT_EQ(answer.parameter, "P05.13");
    EXPECT_EQ(answer.shown, "250 ms");
    EXPECT_THAT(answer.bytes, ElementsAre(std::byte{250}, std::byte{0}));
    EXPECT_EQ(answer.id, "5");
    EXPECT_THAT(log, IsEmpty());
}

TEST_F(DriveRequestsTest, AWriteInManualModeIsDoneAndLogged) {
    EXPECT_EQ(refusal(write, "P05.13", "300 ms"), "accepted");
    EXPECT_EQ(port.words[FakePort::key({0x2005, 0x0E})], 300);
    EXPECT_THAT(log, ElementsAre(AllOf(HasSubstr("process 7"), HasSubstr("P05.13"), HasSubstr("axis x"), HasSubstr("300 ms"))));
}

TEST_F(DriveRequestsTest, WhileAProgramOwnsTheAxisAWriteIsRefusedWithItsName) {
    machine.snapshot.mode = runtime::Mode::automatic;
    machine.snapshot.axes[0].owner = axes::Owner::program;
    const auto answer = ask(write, "P05.13", "300");
    ASSERT_TRUE(answer.error);
    EXPECT_EQ(answer.error->code, "command.no_control");
    EXPECT_THAT(answer.error->what, HasSubstr("a program has control"));
    EXPECT_THAT(answer.error->subject, HasSubstr("axis x"));
    EXPECT_THAT(port.written, IsEmpty());
    EXPECT_THAT(log, IsEmpty());
}

TEST_F(DriveRequestsTest, InAutomaticModeNobodyWritesAlsoToAnAxisThatNobodyOwns) {
    machine.snapshot.mode = runtime::Mode::automatic;
    EXPECT_EQ(refusal(write, "P05.13", "300"), "command.wrong_mode");
    EXPECT_EQ(refusal(store_all), "drive.cannot_store") << "this one stores by writing";
    EXPECT_THAT(port.written, IsEmpty());
}

TEST_F(DriveRequestsTest, WhatMayChangeOnlyWhileTheMotorIsOffWaitsForThat) {
    machine.snapshot.axes[0].drive_state = axes::PowerState::enabled;
    EXPECT_EQ(refusal(write, "P06.00", "1"), "command.not_possible_now");
    EXPECT_EQ(refusal(write, "P05.13", "300"), "accepted") << "its manual lets it change at any time";
    machine.snapshot.axes[0].drive_state = axes::PowerState::disabled;
    EXPECT_EQ(refusal(write, "P06.00", "1"), "accepted");
}

TEST_F(DriveRequestsTest, NothingGoesIntoTheEepromUnlessTheRequestSaysSo) {
    EXPECT_EQ(refusal(write, "P05.10", "1"), "drive.would_store");
    EXPECT_EQ(refusal(write, "P05.10", "0"), "accepted") << "off wears nothing";
    EXPECT_EQ(refusal(write, "P05.10", "1", true), "accepted");
    EXPECT_THAT(log.back(), HasSubstr("into the EEPROM"));
    profile.storage.switched_by = {};  // a drive that always stores
    EXPECT_EQ(refusal(write, "P05.13", "300"), "drive.would_store");
}

TEST_F(DriveRequestsTest, StoringAllNeedsEveryMotorOfTheDriveOff) {
    profile.storage.way = axes::ParameterStorage::on_request;
    machine.snapshot.axes[1].drive_state = axes::PowerState::enabled;  // the other axis of the same drive
    EXPECT_EQ(refusal(store_all), "command.not_possible_now");
    machine.snapshot.axes[1].drive_state = axes::PowerState::disabled;
    EXPECT_EQ(refusal(store_all), "accepted");
    EXPECT_THAT(port.written, ElementsAre(FakePort::key({0x1010, 1}))) << "CiA 301";
    EXPECT_THAT(log, ElementsAre(HasSubstr("in the EEPROM")));
    port.caps.services = 1u << static_cast<unsigned>(axes::DriveService::save_parameters);  // XP200: function 41h
    EXPECT_EQ(refusal(store_all), "accepted");
    EXPECT_THAT(port.services, ElementsAre(axes::DriveService::save_parameters));
}

// TSVM 5.3.2, SV33-E P20.05: an explicit request, with the motor off, by who may write; and the log keeps it.
TEST_F(DriveRequestsTest, TheTurnsAreClearedOnlyOnRequestWithTheMotorOff) {
    EXPECT_EQ(refusal(DriveRequestKind::clear_turns), "drive.no_turns") << "this drive has no such command";
    port.caps.services = 1u << static_cast<unsigned>(axes::DriveService::clear_multi_turn);
    machine.snapshot.axes[0].drive_state = axes::PowerState::enabled;
    EXPECT_EQ(refusal(DriveRequestKind::clear_turns), "command.not_possible_now");
    machine.snapshot.axes[0].drive_state = axes::PowerState::disabled;
    machine.snapshot.mode = runtime::Mode::automatic;
    EXPECT_EQ(refusal(DriveRequestKind::clear_turns), "command.wrong_mode");
    EXPECT_THAT(port.services, IsEmpty());
    EXPECT_THAT(log, IsEmpty());
    machine.snapshot.mode = runtime::Mode::manual;
    EXPECT_EQ(refusal(DriveRequestKind::clear_turns), "accepted");
    EXPECT_THAT(port.services, ElementsAre(axes::DriveService::clear_multi_turn));
    EXPECT_THAT(log, ElementsAre(AllOf(HasSubstr("turns of axis x"), HasSubstr("no reference"))));
}

TEST_F(DriveRequestsTest, WhatCannotBeMeantIsRefusedBeforeTheDriveIsAsked) {
    EXPECT_EQ(refusal(write, "P05.13", "501"), "drive.out_of_range");
    EXPECT_EQ(refusal(write, "P05.13", "1 s"), "drive.out_of_range") << "1000 ms";
    EXPECT_EQ(refusal(write, "P05.13", "1 V"), "drive.value");
    EXPECT_EQ(refusal(write, "603Fh", "1"), "drive.read_only");
    EXPECT_EQ(refusal(write, "P20.05", "2"), "drive.action") << "the axis would lose its reference unseen";
    EXPECT_EQ(refusal(read, "P99.99"), "drive.no_parameter");
    port.mapped = FakePort::key({0x2005, 0x0E});
    EXPECT_EQ(refusal(write, "P05.13", "300"), "drive.not_now") << "the cycle writes it";
    EXPECT_THAT(port.written, IsEmpty());
    requests.handle({read, "turret", "P05.13", "", false, "", 1, "6"}, &machine.snapshot, now);
    EXPECT_EQ(requests.next_answer()->error->code, "drive.none");
    requests.handle({read, "x", "P05.13", "", false, "", 1, "7"}, nullptr, now);
    EXPECT_EQ(requests.next_answer()->error->code, "state.not_yet");
}

TEST_F(DriveRequestsTest, ADriveThatRefusesIsQuotedAndOneThatIsSilentIsGivenUp) {
    port.refuses = true;
    const auto answer = ask(read, "P05.13");
    ASSERT_TRUE(answer.error);
    EXPECT_EQ(answer.error->code, "sdo.abort");
    port.refuses = false;
    port.silent = true;
    requests.handle({read, "x", "P05.13", "", false, "", 1, "8"}, &machine.snapshot, now);
    requests.step(now + 1s);
    EXPECT_FALSE(requests.next_answer());
    requests.step(now + DriveRequests::patience);
    EXPECT_EQ(requests.next_answer()->error->code, "drive.silent");
}

TEST_F(DriveRequestsTest, OnlySoManyAreUnderWay) {
    port.silent = true;
    for (std::size_t i = 0; i < DriveRequests::at_work; ++i)
        requests.handle({read, "x", "P05.13", "", false, "", 1, "9"}, &machine.snapshot, now);
    EXPECT_FALSE(requests.next_answer());
    EXPECT_EQ(refusal(read, "P05.13"), "command.queue_full");
    requests.forget(1);
    requests.step(now + 10s);
    EXPECT_FALSE(requests.next_answer()) << "nobody waits for them any more";
    port.silent = false;
    EXPECT_EQ(refusal(read, "P05.13"), "accepted") << "and their places are free";
}

// What a write changes is part of the other one's motion: ramps, limits, gains.
TEST_F(DriveRequestsTest, NobodyWritesWhileAnotherHandMovesAnAxisOfTheDriveOrHoldsItUnderPower) {
    Hands hands;
    DriveRequests guarded{machine, [this](std::string_view line) { log.emplace_back(line); }, &hands};
    const auto asks = [&](std::uint32_t client) {
        guarded.handle({write, "x", "P05.13", "300 ms", false, "process 7", 1, "5", client}, &machine.snapshot, now);
        guarded.step(now += 5ms);
        const auto answer = guarded.next_answer();
        return answer && !answer->error ? std::string("accepted") : answer ? answer->error->code + ": " + answer->error->what : "none";
    };
    auto& x = machine.snapshot.axes[0];
    auto& y = machine.snapshot.axes[1];  // of the same drive
    EXPECT_EQ(asks(1), "accepted");

    x.drive_state = axes::PowerState::enabled;
    x.state = axes::AxisState::Standstill;
    EXPECT_EQ(asks(1), "accepted") << "nobody has it";
    hands.lay(0, 2, "process 8");
    EXPECT_EQ(asks(1), "command.no_control: process 8 commands it");
    EXPECT_EQ(asks(2), "accepted") << "it is his";
    x.state = axes::AxisState::DiscreteMotion;
    EXPECT_EQ(asks(1), "command.no_control: it moves, and process 8 moves it");
    EXPECT_EQ(asks(2), "accepted") << "his own motion";
    hands.lift_all(2);
    EXPECT_EQ(asks(2), "command.no_control: it moves, and a client that is gone moves it");
    x.state = axes::AxisState::Standstill;
    EXPECT_EQ(asks(1), "accepted");

    y.state = axes::AxisState::ErrorStop;
    y.set_velocity = 3;
    EXPECT_EQ(asks(1), "command.no_control: it moves, and a client that is gone moves it") << "the other axis of the drive ramps down";
    y.set_velocity = 0;
    EXPECT_EQ(asks(1), "accepted");
    x.drive_state = axes::PowerState::disabled;
    x.owner = axes::Owner::commissioning;
    hands.lay(0, 2, "process 8");
    EXPECT_EQ(asks(1), "command.no_control: process 8 commands it") << "he took control";
    EXPECT_EQ(port.written.size(), 6u);
}

// The same as lines of the socket.
TEST_F(DriveRequestsTest, TheSocketSpeaksOfThem) {
    Gateway gateway{machine};
    JsonRequests lines{gateway, machine, [] { return std::int64_t{0}; }, [this](std::string_view line) { log.emplace_back(line); }};
    lines.observe(&machine.snapshot);
    lines.on_open(3, {812, 1000, 1000});
    const auto say = [&](const char* line) {
        lines.on_line(3, line, now);
        lines.step(now += 5ms);
        const auto answer = lines.next_line();
        return answer ? nlohmann::json::parse(answer->text) : nlohmann::json{};
    };
    EXPECT_EQ(say(R"({"id":1,"cmd":"drive_read","axis":"x","parameter":"P05.13"})"),
              (nlohmann::json{{"id", 1}, {"ok", true}, {"parameter", "P05.13"}, {"shown", "250 ms"}, {"bytes", {250, 0}}}));
    EXPECT_EQ(say(R"({"id":2,"cmd":"drive_write","axis":"x","parameter":"P05.13","value":"300 ms"})")["ok"], true);
    EXPECT_THAT(log, ElementsAre(::testing::ContainsRegex("process 812.* of user 1000 writes P05.13")));
    EXPECT_EQ(say(R"({"id":3,"cmd":"drive_store","axis":"x"})")["error"]["code"], "drive.cannot_store");
    EXPECT_EQ(say(R"({"id":6,"cmd":"drive_clear_turns","axis":"x"})")["error"]["code"], "drive.no_turns");
    EXPECT_EQ(say(R"({"id":4,"cmd":"drive_write","axis":"x","parameter":"P05.13"})")["error"]["code"], "request.missing_key");
    EXPECT_EQ(say(R"({"id":5,"cmd":"drive_raed","axis":"x"})")["error"]["code"], "request.unknown_command");
}

// What changes a drive, and has waited, is not what anybody wants now. What is only read hurts nobody.
TEST_F(DriveRequestsTest, AWriteThatComesTooLateIsRefused) {
    constexpr std::int64_t wall = 1'800'000'000'000'000;  // us since 1970
    Gateway gateway{machine};
    JsonRequests lines{gateway, machine, [] { return wall; }, [this](std::string_view line) { log.emplace_back(line); }};
    lines.observe(&machine.snapshot);
    lines.on_open(3, {812, 1000, 1000});
    const auto say = [&](const std::string& line, Duration waited = {}) {
        lines.on_request(3, line, now, waited > Duration{} ? Arrival{.at = now - waited} : Arrival{});
        lines.step(now += 5ms);
        const auto answer = lines.next_line();
        const auto parsed = answer ? nlohmann::json::parse(answer->text) : nlohmann::json{};
        return parsed.value("ok", false) ? std::string("ok") : parsed["error"]["code"].get<std::string>();
    };
    const std::string write = R"("cmd":"drive_write","axis":"x","parameter":"P05.13","value":"300 ms")";
    const auto sent = [&](std::int64_t us_ago) { return ",\"utime\":" + std::to_string(wall - us_ago) + "}"; };
    EXPECT_EQ(say("{" + write + sent(1'000'001)), "command.stale");
    EXPECT_EQ(say("{" + write + R"(,"valid_ms":50)" + sent(50'001)), "command.stale");
    EXPECT_EQ(say("{" + write + sent(-1'000'001)), "command.stale");
    EXPECT_EQ(say("{" + write + R"(,"valid_ms":0})"), "command.bad_value");
    EXPECT_EQ(say("{" + write + "}", 1001ms), "command.stale");
    EXPECT_EQ(say(R"({"cmd":"drive_store","axis":"x")" + sent(1'000'001)), "command.stale");
    EXPECT_EQ(say(R"({"cmd":"drive_clear_turns","axis":"x")" + sent(1'000'001)), "command.stale");
    EXPECT_TRUE(port.written.empty());
    EXPECT_TRUE(log.empty());
    EXPECT_EQ(say(R"({"cmd":"drive_read","axis":"x","parameter":"P05.13")" + sent(5'000'000)), "ok");
    EXPECT_EQ(say(R"({"cmd":"drive_read","axis":"x","parameter":"P05.13","valid_ms":50})"), "request.unknown_key");
    EXPECT_EQ(say("{" + write + sent(1'000'000)), "ok");
    EXPECT_EQ(say("{" + write + "}", 1000ms), "ok");
    EXPECT_EQ(port.written.size(), 2u);
}

}  // namespace
}  // namespace taktwerk::hmi
