// From a fault to the curve on a screen: the alarm names its recording, the list has it, and what is read of it is what the cycle had.
#include <gmock/gmock.h>

#include <bit>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "hmi_bridge/gateway/gateway.hpp"
#include "hmi_bridge/runtime_link.hpp"
#include "hmi_bridge/socket/json_requests.hpp"
#include "runtime/flight/flight_recorder.hpp"
#include "tests/hmi_bridge/base64_text.hpp"
#include "tests/runtime/test_machine.hpp"

namespace taktwerk::hmi {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;
using runtime::testing::TestMachine;

class Recordings : public testing::Test {
protected:
    Recordings() : m(config()) {
        auto pattern = (std::filesystem::temp_directory_path() / "taktwerk-recordings-XXXXXX").string();
        folder = ::mkdtemp(pattern.data());
        recorder = std::move(runtime::FlightRecorder::open(*m.machine, folder, {})).value();
        link.set_recorder(recorder.get());
        requests.set_recorder(recorder.get());
        requests.on_open(1, {100, 1000, 1000});
        EXPECT_TRUE(m.up());
        m.enable(0);
    }
    ~Recordings() override { std::filesystem::remove_all(folder); }
    static runtime::MachineConfig config() {
        auto config = runtime::testing::machine_config(2);
        config.recording.depth = 5s;
        config.recording.before = 500ms;
        config.recording.after = 200ms;
        return config;
    }
    void step() {
        m.run(1ms);
        if (const auto* snapshot = link.latest()) recorder->look(*snapshot);
        (void)recorder->work();
        requests.observe(link.latest());
        requests.step(m.clock.now());
    }
    void run(int steps) {
        for (int i = 0; i < steps; ++i) step();
    }
    json ask(json request) {
        request["id"] = ++id;
        requests.observe(link.latest());
        requests.on_line(1, request.dump(), m.clock.now());
        for (int i = 0; i < 1000; ++i) {
            if (const auto line = requests.next_line()) return json::parse(line->text);
            step();
        }
        ADD_FAILURE() << "no answer to " << request;
        return {};
    }

    TestMachine m;
    std::string folder;
    RuntimeLink link{*m.machine};
    Gateway gateway{link};
    JsonRequests requests{gateway, link, [] { return std::int64_t{1'800'000'000'000'000}; }};
    std::unique_ptr<runtime::FlightRecorder> recorder;
    int id = 0;
};

TEST_F(Recordings, AnAlarmNamesItsRecordingAndItIsReadAsTheMachineWas) {
    EXPECT_EQ(ask({{"cmd", "recordings"}})["recordings"], json::array());
    run(800);
    m.world.drive("x")->raise(0x3130);
    run(20);

    const auto alarm = ask({{"cmd", "state"}})["state"]["alarms"][0];
    const std::string name = alarm["recording"];
    auto listed = ask({{"cmd", "recordings"}})["recordings"];
    ASSERT_EQ(listed.size(), 1u);
    EXPECT_EQ(listed[0]["name"], name);
    EXPECT_EQ(listed[0]["alarm"], alarm["name"]);
    EXPECT_EQ(listed[0]["source"], "axis x");
    EXPECT_EQ(listed[0]["complete"], false);
    EXPECT_EQ(ask({{"cmd", "recording_signals"}, {"recording", name}})["error"]["code"], "recording.not_yet");
    run(400);

    listed = ask({{"cmd", "recordings"}})["recordings"];
    EXPECT_EQ(listed[0]["complete"], true);
    const std::uint64_t from = listed[0]["from"], to = listed[0]["to"], alarm_cycle = listed[0]["alarm_cycle"];
    EXPECT_EQ(alarm_cycle - from, 500u);
    const auto signals = ask({{"cmd", "recording_signals"}, {"recording", name}})["scope"];
    EXPECT_EQ(signals["signals"], ask({{"cmd", "scope_signals"}})["scope"]["signals"]);
    EXPECT_EQ(signals["first"], from);
    EXPECT_EQ(signals["last"], to - 1);

    // The machine still has these cycles in memory: the file and the memory say the same.
    const json names{"x.actual_position", "x.drive_error", "x.status_word", "time_s"};
    const auto kept = ask({{"cmd", "recording_read"}, {"recording", name}, {"signals", names}, {"from", from}, {"to", to}});
    const auto live = ask({{"cmd", "scope_read"}, {"signals", names}, {"from", from}, {"to", to}});
    EXPECT_EQ(kept["missing"], 0);
    EXPECT_EQ(kept["per"], 1);
    EXPECT_EQ(kept["data"], live["data"]);
    EXPECT_EQ(kept["time_ns"], live["time_ns"]);
    const auto errors = numbers_of(kept["data"][1]);
    EXPECT_EQ(errors.at(alarm_cycle - from - 1), 0);
    EXPECT_EQ(errors.at(alarm_cycle - from), 0x3130);
}

// Whoever copies a recording has the file that lies on the disk, byte by byte.
TEST_F(Recordings, ItsFileIsGivenInParts) {
    run(800);
    m.world.drive("x")->raise(0x3130);
    run(20);
    const std::string name = ask({{"cmd", "state"}})["state"]["alarms"][0]["recording"];
    EXPECT_EQ(ask({{"cmd", "recording_part"}, {"recording", name}})["error"]["code"], "recording.not_yet");
    run(400);
    std::ifstream file{folder + "/" + name + ".twscope", std::ios::binary};
    const std::string on_disk{std::istreambuf_iterator<char>{file}, {}};
    ASSERT_FALSE(on_disk.empty());

    std::string copied;
    while (copied.size() < on_disk.size()) {
        const auto part = ask({{"cmd", "recording_part"}, {"recording", name}, {"from", copied.size()}});
        ASSERT_EQ(part["ok"], true) << part;
        EXPECT_EQ(part["size"], on_disk.size());
        EXPECT_EQ(part["from"], copied.size());
        const auto bytes = bytes_of(part["data"]);
        ASSERT_FALSE(bytes.empty());
        EXPECT_LE(bytes.size(), runtime::FlightRecorder::part_bytes);
        copied += bytes;
    }
    EXPECT_EQ(copied, on_disk);
    const auto behind = ask({{"cmd", "recording_part"}, {"recording", name}, {"from", on_disk.size()}});
    EXPECT_EQ(behind["data"], "");
}

TEST_F(Recordings, WhatThereIsNotIsSaid) {
    EXPECT_EQ(ask({{"cmd", "recording_part"}, {"recording", "../../etc/passwd"}})["error"]["code"], "recording.unknown");
    EXPECT_EQ(ask({{"cmd", "recording_part"}})["error"]["code"], "request.missing_key");
    EXPECT_EQ(ask({{"cmd", "recording_signals"}, {"recording", "../../etc/passwd"}})["error"]["code"], "recording.unknown");
    EXPECT_EQ(ask({{"cmd", "recording_read"}, {"recording", "none"}, {"signals", {"x.state"}}})["error"]["code"], "recording.unknown");
    EXPECT_EQ(ask({{"cmd", "recording_read"}, {"recording", "none"}})["error"]["code"], "request.missing_key");
    EXPECT_EQ(ask({{"cmd", "recording_signals"}})["error"]["code"], "request.missing_key");
    EXPECT_EQ(ask({{"cmd", "recordings"}, {"recording", "none"}})["error"]["code"], "request.unknown_key");
}

TEST_F(Recordings, ATriggerOnAnAlarmIsTheCycleOfTheAlarm) {
    const json when{{"kind", "alarm"}};
    EXPECT_EQ(ask({{"cmd", "scope_arm"}, {"when", when}, {"pre", 50}, {"post", 20}})["ok"], true);
    run(100);
    EXPECT_EQ(ask({{"cmd", "scope_state"}})["scope"]["events"], json::array());
    m.world.drive("x")->raise(0x3130);
    run(100);

    const auto state = ask({{"cmd", "scope_state"}})["scope"];
    ASSERT_EQ(state["events"].size(), 1u);
    const auto& event = state["events"][0];
    EXPECT_EQ(event["cycle"], ask({{"cmd", "recordings"}})["recordings"][0]["alarm_cycle"]);
    EXPECT_EQ(event["from"], event["cycle"].get<std::uint64_t>() - 50);
    EXPECT_EQ(event["to"], event["cycle"].get<std::uint64_t>() + 20);
    EXPECT_EQ(event["complete"], true);
    EXPECT_EQ(state["armed"], false);
}

// A pulse of a millisecond on an input, ten seconds of nothing around it: no polling page would see it.
TEST_F(Recordings, ATriggerSeesAPulseOfOneCycle) {
    const json when{{"kind", "rising"}, {"signal", "in.button"}, {"level", 0.5}};
    EXPECT_EQ(ask({{"cmd", "scope_arm"}, {"when", when}, {"pre", 5}, {"post", 5}})["ok"], true);
    run(300);
    m.world.set_input("button", 1);
    run(1);
    m.world.set_input("button", 0);
    run(300);

    const auto state = ask({{"cmd", "scope_state"}})["scope"];
    ASSERT_EQ(state["events"].size(), 1u);
    const auto& event = state["events"][0];
    const auto seen = ask({{"cmd", "scope_read"}, {"signals", {"in.button"}}, {"from", event["from"]}, {"to", event["to"]}});
    EXPECT_EQ(numbers_of(seen["data"][0]), (std::vector<double>{0, 0, 0, 0, 0, 1, 0, 0, 0, 0}));
}

TEST_F(Recordings, BrokenTriggersGetOneClearErrorEach) {
    const auto code = [&](const json& when) { return ask({{"cmd", "scope_arm"}, {"when", when}})["error"]["code"].get<std::string>(); };
    EXPECT_EQ(code(1), "request.wrong_type");
    EXPECT_EQ(code(json::object()), "request.missing_key");
    EXPECT_EQ(code({{"kind", "sideways"}, {"signal", "x.state"}}), "scope.condition");
    EXPECT_EQ(code({{"kind", "rising"}, {"signal", "x.state"}}), "request.missing_key");
    EXPECT_EQ(code({{"kind", "rising"}, {"level", 1}}), "request.missing_key");
    EXPECT_EQ(code({{"kind", "rising"}, {"level", 1}, {"signal", "x.stat"}}), "scope.unknown_signal");
    EXPECT_EQ(code({{"kind", "rising"}, {"level", 1}, {"level2", 1}, {"signal", "x.state"}}), "request.unknown_key");
    EXPECT_EQ(code({{"kind", "inside"}, {"level", 2}, {"level2", 1}, {"signal", "x.state"}}), "scope.condition");
    EXPECT_EQ(code({{"kind", "bit"}, {"bit", 53}, {"signal", "x.state"}}), "scope.condition");
    EXPECT_EQ(code({{"kind", "alarm"}, {"signal", "x.state"}}), "request.unknown_key");
    const json good{{"kind", "above"}, {"level", 1}, {"signal", "x.state"}};
    EXPECT_EQ(ask({{"cmd", "scope_arm"}, {"when", good}, {"mode", "twice"}})["error"]["code"], "scope.condition");
    EXPECT_EQ(ask({{"cmd", "scope_arm"}, {"when", good}, {"pre", -1}})["error"]["code"], "request.wrong_type");
    EXPECT_EQ(ask({{"cmd", "scope_state"}})["scope"]["armed"], false) << "none of them was armed";
    EXPECT_EQ(ask({{"cmd", "scope_arm"}, {"when", good}, {"pre", INT64_MAX}, {"post", INT64_MAX}, {"holdoff", INT64_MAX}})["ok"], true);
    EXPECT_EQ(ask({{"cmd", "scope_disarm"}})["ok"], true);
    EXPECT_EQ(ask({{"cmd", "scope_state"}})["scope"]["armed"], false);
}

}  // namespace
}  // namespace taktwerk::hmi
