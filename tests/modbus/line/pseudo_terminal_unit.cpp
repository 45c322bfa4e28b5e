// A real terminal pair: what a program outside and TtyLine make of it. Nothing waits: both ends are in this process.

#include "modbus/line/pseudo_terminal.hpp"

#include <gtest/gtest.h>
#include <poll.h>

#include "modbus/line/tty_line.hpp"
#include "tests/modbus/line/echo_station.hpp"

namespace taktwerk::modbus {
namespace {

using namespace std::chrono_literals;

TEST(PseudoTerminal, ATtyOnTheOtherSideGetsAnswers) {
    auto served = PseudoTerminal::open(LineSettings{});
    ASSERT_TRUE(served.ok()) << served.error().text();
    EchoStation station{1};
    (*served)->connect(station);
    auto tty = TtyLine::open((*served)->path(), LineSettings{});
    ASSERT_TRUE(tty.ok()) << tty.error().text();

    ASSERT_TRUE((*tty)->send(encode(read_status(1, 0, 2)).span(), Instant{}));
    pollfd asked{(*served)->descriptor(), POLLIN, 0};
    ASSERT_EQ(::poll(&asked, 1, 1000), 1);
    (*served)->step(Instant{});

    const auto expected = encode_response(read_status(1, 0, 2), std::span{station.values}.first(2));
    std::array<std::byte, 64> into{};
    std::size_t got = 0;
    for (int i = 0; i < 1'000'000 && got < expected.size; ++i) got += (*tty)->receive(std::span{into}.subspan(got), Instant{});
    ASSERT_EQ(got, expected.size);
    EXPECT_TRUE(std::equal(into.begin(), into.begin() + static_cast<std::ptrdiff_t>(got), expected.bytes.begin()));
}

// A function that the table does not know has no length: silence ends its frame, and the next one is understood again.
TEST(PseudoTerminal, SilenceEndsAFrameOfUnknownLength) {
    auto served = PseudoTerminal::open(LineSettings{});
    ASSERT_TRUE(served.ok());
    EchoStation station{1};
    (*served)->connect(station);
    auto tty = TtyLine::open((*served)->path(), LineSettings{});
    ASSERT_TRUE(tty.ok());
    const std::array<std::byte, 5> strange{std::byte{1}, std::byte{0x2B}, std::byte{0}, std::byte{0}, std::byte{0}};
    ASSERT_TRUE((*tty)->send(strange, Instant{}));
    pollfd asked{(*served)->descriptor(), POLLIN, 0};
    ASSERT_EQ(::poll(&asked, 1, 1000), 1);
    (*served)->step(Instant{});
    (*served)->step(Instant{10ms});
    ASSERT_TRUE((*tty)->send(encode(clear_alarm(1)).span(), Instant{20ms}));
    ASSERT_EQ(::poll(&asked, 1, 1000), 1);
    (*served)->step(Instant{20ms});
    EXPECT_EQ(station.requests.size(), 1u);
}

TEST(TtyLine, SaysWhatIsWrongWithAPort) {
    const auto nowhere = TtyLine::open("/dev/no-such-port", LineSettings{});
    ASSERT_FALSE(nowhere.ok());
    EXPECT_EQ(nowhere.error().code, "serial.open");
    EXPECT_NE(nowhere.error().text().find("/dev/no-such-port"), std::string::npos);
    const auto no_tty = TtyLine::open("/dev/null", LineSettings{});
    ASSERT_FALSE(no_tty.ok());
    EXPECT_EQ(no_tty.error().code, "serial.settings");
    auto served = PseudoTerminal::open(LineSettings{});
    ASSERT_TRUE(served.ok());
    const auto odd = TtyLine::open((*served)->path(), LineSettings{12345, Parity::even, 1});
    ASSERT_FALSE(odd.ok());
    EXPECT_EQ(odd.error().code, "serial.settings");
}

}  // namespace
}  // namespace taktwerk::modbus
