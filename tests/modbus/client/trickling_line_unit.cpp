// Bytes that trickle in, each within the pause that an adapter may make, hold the line no longer than an answer may take.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "modbus/client/client.hpp"
#include "modbus/wire/crc.hpp"

using namespace std::chrono_literals;

namespace taktwerk::modbus {
namespace {

class TricklingLine final : public SerialLine {
public:
    std::vector<std::byte> arrived;
    [[nodiscard]] const LineSettings& settings() const noexcept override { return settings_; }
    bool send(std::span<const std::byte>, Instant) override { return true; }
    std::size_t receive(std::span<std::byte> into, Instant) override {
        const auto taken = std::min(into.size(), arrived.size());
        std::copy_n(arrived.begin(), taken, into.begin());
        arrived.erase(arrived.begin(), arrived.begin() + static_cast<std::ptrdiff_t>(taken));
        return taken;
    }
    void discard(Instant) override { arrived.clear(); }
    [[nodiscard]] bool present() const noexcept override { return true; }

private:
    LineSettings settings_;
};

/// What a drive says to "eight words from 4 on".
std::vector<std::byte> eight_words() {
    std::vector<std::byte> bytes{std::byte{1}, static_cast<std::byte>(Function::read_parameters), std::byte{16}};
    for (int i = 0; i < 16; ++i) bytes.push_back(static_cast<std::byte>(i));
    const auto check = crc16(bytes);
    bytes.push_back(static_cast<std::byte>(check & 0xFF));
    bytes.push_back(static_cast<std::byte>(check >> 8));
    return bytes;
}

/// The answer to the question, which arrives `piece` bytes at a time, every `every` milliseconds, over and over.
std::optional<Answer> ask(std::size_t piece, int every) {
    TricklingLine line;
    Client client{line};
    Instant now{1s};
    EXPECT_EQ(client.ask(read_parameters(1, 4, 8), now), Refusal::none);
    const auto said = eight_words();
    std::size_t at = 0;
    for (int ms = 1; ms < 2000; ++ms) {
        now += 1ms;
        if (ms % every == 0)
            for (std::size_t i = 0; i < piece; ++i) line.arrived.push_back(said[at++ % said.size()]);
        if (auto answer = client.step(now)) return answer;
    }
    return std::nullopt;
}

TEST(TricklingLine, EndsWithinTheTimeOfItsTries) {
    const auto answer = ask(1, 19);
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->outcome, Outcome::damaged);
    TricklingLine line;
    const Client client{line};
    EXPECT_LE(answer->took, 2 * (client.worst_time(8, eight_words().size()) + 25ms));  // the pause, and a step each way
}

TEST(TricklingLine, AnAnswerInTwoPiecesIsAnAnswer) {  // the control
    const auto answer = ask(11, 16);
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->outcome, Outcome::answered);
    EXPECT_EQ(answer->response.count, 8);
}

}  // namespace
}  // namespace taktwerk::modbus
