// One transaction at a time on a computed line.

#include "modbus/client/client.hpp"

#include <gtest/gtest.h>

#include "modbus/line/virtual_line.hpp"
#include "tests/modbus/line/echo_station.hpp"
#include "tests/patience.hpp"

namespace taktwerk::modbus {
namespace {

using namespace std::chrono_literals;

struct Rig {
    VirtualLine line{LineSettings{}};
    EchoStation station{1};
    Client client{line, {.answer_timeout = 50ms, .tries = 2}};
    Instant now{};

    Rig() { line.connect(station); }
    /// Steps of 1 ms until there is an answer.
    std::optional<Answer> wait(Duration patience = 2s) {
        for (const auto until = now + patience; now < until;) {
            now += 1ms;
            if (auto answer = client.step(now)) return answer;
        }
        return std::nullopt;
    }
    Refusal ask(const Request& request) {
        for (Patience patience; patience.lasts(!client.idle(now));) {
            now += 1ms;
            (void)client.step(now);
        }
        return client.ask(request, now);
    }
};

// 16.745 ms on the wire (virtual_line_unit.cpp), seen in the step of the 17th millisecond.
TEST(ModbusClient, AnswerComesWithItsWordsAndTimes) {
    Rig rig;
    ASSERT_EQ(rig.ask(read_status(1, 5, 2)), Refusal::none);
    const auto answer = rig.wait();
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->outcome, Outcome::answered);
    EXPECT_EQ(answer->response.words[0], 0x1122);
    EXPECT_EQ(answer->response.words[1], 0x3344);
    EXPECT_EQ(answer->took, 17ms);
    // The drive looked when it had heard (6.589 ms) and before it answered (11.589 ms).
    EXPECT_GT(answer->sampled, Instant{6'588us});
    EXPECT_LT(answer->sampled, Instant{12ms});
    EXPECT_EQ(rig.client.statistics().answered, 1u);
    EXPECT_EQ(rig.client.statistics().retries, 0u);
}

// Manual 9.3: 3.5 characters of silence between an answer and the next request: 2.005 ms.
TEST(ModbusClient, TheLineRestsBetweenFrames) {
    Rig rig;
    ASSERT_EQ(rig.ask(clear_alarm(1)), Refusal::none);
    ASSERT_TRUE(rig.wait());
    EXPECT_EQ(rig.client.ask(clear_alarm(1), rig.now + 2ms), Refusal::busy);
    EXPECT_EQ(rig.client.ask(clear_alarm(1), rig.now + 2'006us), Refusal::none);
    EXPECT_EQ(rig.client.ask(clear_alarm(1), rig.now + 3ms), Refusal::busy);
}

TEST(ModbusClient, ALostAnswerIsAskedForAgain) {
    Rig rig;
    rig.line.lose_answers(1);
    ASSERT_EQ(rig.ask(write_parameter(1, 138, 100)), Refusal::none);
    const auto answer = rig.wait();
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->outcome, Outcome::answered);
    EXPECT_EQ(rig.station.requests.size(), 2u);
    EXPECT_EQ(rig.client.statistics().retries, 1u);
    EXPECT_EQ(rig.client.statistics().timeouts, 1u);
}

TEST(ModbusClient, ADamagedOrShortAnswerIsAskedForAgain) {
    for (const bool shortened : {false, true}) {
        Rig rig;
        shortened ? rig.line.shorten_answers(1) : rig.line.damage_answers(1);
        ASSERT_EQ(rig.ask(read_status(1, 5, 2)), Refusal::none);
        const auto answer = rig.wait();
        ASSERT_TRUE(answer);
        EXPECT_EQ(answer->outcome, Outcome::answered);
        EXPECT_EQ(rig.client.statistics().damaged, 1u);
        EXPECT_EQ(rig.station.requests.size(), 2u);
    }
}

// Two tries of 4.6 ms out and 50 ms patience each: a silent drive is known after about 0.12 s.
TEST(ModbusClient, SilenceHasAnEnd) {
    Rig rig;
    rig.line.cut(true);
    ASSERT_EQ(rig.ask(read_status(1, 5, 2)), Refusal::none);
    const auto answer = rig.wait();
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->outcome, Outcome::silent);
    EXPECT_GE(answer->took, 109ms);
    EXPECT_LE(answer->took, 115ms);
    EXPECT_EQ(rig.client.statistics().timeouts, 2u);
}

// Manual 9.6.1, 9.6.2: at most 8 words in one reading; 9.6.4: at most 10 in one writing.
TEST(ModbusClient, TheDrivesLimitsAreKept) {
    Rig rig;
    const std::array<std::uint16_t, 11> words{};
    EXPECT_EQ(rig.ask(read_status(1, 0, 9)), Refusal::too_many_words);
    EXPECT_EQ(rig.ask(read_parameters(1, 0, 9)), Refusal::too_many_words);
    EXPECT_EQ(rig.ask(write_parameters(1, 100, words)), Refusal::too_many_words);
    EXPECT_EQ(rig.ask(read_status(1, 0, 0)), Refusal::no_words);
    EXPECT_TRUE(rig.station.requests.empty());
    EXPECT_EQ(rig.ask(write_parameters(1, 100, std::span{words}.first(10))), Refusal::none);
}

// Manual 9.6.6: after a save nothing for 5 s. A lost answer to it is not repeated: it wears the memory.
TEST(ModbusClient, AfterSavingThatStationIsLeftAlone) {
    Rig rig;
    EchoStation other{2};
    rig.line.connect(other);
    rig.line.lose_answers(1);
    ASSERT_EQ(rig.ask(save(1)), Refusal::none);
    const auto answer = rig.wait();
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->outcome, Outcome::silent);
    EXPECT_EQ(rig.station.requests.size(), 1u);
    const auto saved = rig.now;

    EXPECT_EQ(rig.ask(read_status(1, 0, 1)), Refusal::saving);
    EXPECT_EQ(rig.ask(read_status(2, 0, 1)), Refusal::none);
    ASSERT_TRUE(rig.wait());
    rig.now = saved + 4'999ms;
    EXPECT_EQ(rig.ask(read_status(1, 0, 1)), Refusal::saving);
    rig.now = saved + 5s;
    EXPECT_EQ(rig.ask(read_status(1, 0, 1)), Refusal::none);
}

/// Says how far it has lived, and nothing else.
class Living final : public Station {
public:
    void advance(Instant now) override { until = now; }
    bool hear(std::span<const std::byte>, Instant, Frame&) override { return false; }
    [[nodiscard]] Duration turnaround() const noexcept override { return {}; }
    [[nodiscard]] LineSettings line() const noexcept override { return {}; }
    Instant until{};
};

// A motor turns on while nobody asks it anything: between two questions, while the line rests after a failed try, and while it saves.
TEST(ModbusClient, AQuietClientLetsTheDrivesLiveOn) {
    VirtualLine line{LineSettings{}};
    Living station;
    line.connect(station);
    Client client{line};
    (void)client.step(Instant{10ms});
    EXPECT_EQ(station.until, Instant{10ms}) << "idle";

    ASSERT_EQ(client.ask(clear_alarm(1), Instant{20ms}), Refusal::none);  // 4 characters of 572.9 us out, then 50 ms of patience: 72.3 ms
    EXPECT_FALSE(client.step(Instant{73ms})) << "it will be asked again";
    (void)client.step(Instant{74ms});  // 3.5 characters are 2.005 ms
    EXPECT_EQ(station.until, Instant{74ms}) << "resting";
}

// What comes without a question, or too late for it, is not the next one's answer, and does not pile up.
TEST(ModbusClient, WhatNobodyAskedForIsThrownAway) {
    Rig rig;
    ASSERT_EQ(rig.ask(read_status(1, 5, 2)), Refusal::none);
    ASSERT_TRUE(rig.wait());
    ASSERT_TRUE(rig.line.send(encode(read_status(1, 5, 2)).span(), rig.now));  // somebody else on the line
    rig.now += 1s;
    EXPECT_FALSE(rig.client.step(rig.now));
    std::array<std::byte, 8> into{};
    EXPECT_EQ(rig.line.receive(into, rig.now), 0u);
}

/// Answers every request with its address, each so late that the client has asked again; both answers come.
class LateLine final : public SerialLine {
public:
    static constexpr Duration late = 60ms;
    [[nodiscard]] const LineSettings& settings() const noexcept override { return settings_; }
    bool send(std::span<const std::byte> frame, Instant now) override {
        const auto heard = parse_request(frame).request;
        std::array<std::uint16_t, words_in_frame> words{};
        words.fill(heard.address);
        coming_.push_back({now + late, encode_response(heard, std::span{words}.first(heard.count))});
        return true;
    }
    std::size_t receive(std::span<std::byte> into, Instant now) override {
        if (coming_.empty() || coming_.front().first > now) return 0;
        const auto frame = coming_.front().second;
        coming_.erase(coming_.begin());
        std::copy_n(frame.bytes.begin(), frame.size, into.begin());
        return frame.size;
    }
    void discard(Instant now) override {
        std::erase_if(coming_, [&](const auto& each) { return each.first <= now; });
    }
    [[nodiscard]] bool present() const noexcept override { return true; }

private:
    LineSettings settings_;
    std::vector<std::pair<Instant, Frame>> coming_;
};

// Manual 9.6.1: the answer to a reading is count and words, no address. Those that come twice because the first was late, 10 ms behind the 50 ms
// of patience, must not become the next block's.
TEST(ModbusClient, ALateAnswerIsNotTheNextReadings) {
    LateLine line;
    Client client{line, {.answer_timeout = 50ms, .tries = 2}};
    Instant now{};
    for (const std::uint16_t first : std::array<std::uint16_t, 4>{60, 75, 79, 100}) {
        for (Patience patience; patience.lasts(client.ask(read_parameters(1, first, 4), now) != Refusal::none);)
            (void)client.step(now += 1ms);
        std::optional<Answer> answer;
        for (Patience patience; patience.lasts(!answer);) answer = client.step(now += 1ms);
        EXPECT_EQ(answer->outcome, Outcome::answered);
        EXPECT_EQ(answer->response.words[0], first);
    }
}

TEST(ModbusClient, AnExceptionIsAnAnswer) {
    class Refusing final : public Station {
    public:
        void advance(Instant) override {}
        bool hear(std::span<const std::byte> frame, Instant, Frame& answer) override {
            const auto heard = parse_request(frame);
            answer = encode_exception(heard.station, heard.function_byte, ExceptionCode::busy);
            return true;
        }
        [[nodiscard]] Duration turnaround() const noexcept override { return {}; }
        [[nodiscard]] LineSettings line() const noexcept override { return {}; }
    } station;
    VirtualLine line{LineSettings{}};
    line.connect(station);
    Client client{line};
    ASSERT_EQ(client.ask(write_parameter(1, 138, 100), Instant{}), Refusal::none);
    const auto answer = client.step(Instant{1s});
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->outcome, Outcome::exception);
    EXPECT_EQ(answer->response.exception, ExceptionCode::busy);
    EXPECT_EQ(client.statistics().retries, 0u);
}

}  // namespace
}  // namespace taktwerk::modbus
