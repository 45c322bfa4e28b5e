// What two halves of a broken ring answer together is what the whole line would have answered: the same frames go to six slaves in a line
// with one interface, and to six in a ring that breaks, heals and breaks elsewhere.

#include <gtest/gtest.h>

#include <random>

#include "tests/ecat/ring/ring_probe.hpp"
#include "tests/property_cases.hpp"

namespace taktwerk::ecat::test {
namespace {

constexpr std::size_t line_of = 6;
constexpr std::uint16_t ram = 0x1000;
constexpr std::uint32_t logical_a_slave = 8;
constexpr std::uint16_t written = 4, read_back = 4;

/// Each slave writes four bytes of the logical image into its memory and fills in the four behind them.
void map_logical(sim::SimNetwork& network) {
    for (std::uint16_t s = 0; s < line_of; ++s) {
        const auto write = [&](std::uint16_t ado, const Bytes& data) {
            std::array<std::byte, max_frame_size> buffer{};
            FrameBuilder builder{buffer, MacAddress{0, 1, 2, 3, 4, 5}};
            const auto area = builder.add(Command::APWR, 1, Address::position(s, ado), data.size());
            std::copy(data.begin(), data.end(), area.begin());
            const auto size = builder.finish().size();
            (void)network.process(std::span{buffer}.first(size), network.now());
        };
        write(reg::station_address, bytes_of(static_cast<std::uint16_t>(0x1001 + s)));
        const std::uint32_t start = logical_a_slave * s;
        Fmmu out, in;
        out.logical_start = start, out.length = written, out.physical_start = ram, out.write = true, out.active = true;
        in.logical_start = start + written, in.length = read_back, in.physical_start = ram + 0x100, in.read = true, in.active = true;
        Bytes registers(Fmmu::size);
        encode(out, std::span<std::byte, Fmmu::size>{registers});
        write(reg::fmmu_at(0), registers);
        encode(in, std::span<std::byte, Fmmu::size>{registers});
        write(reg::fmmu_at(1), registers);
    }
}

struct Question {
    Command command{};
    Address address{};
    Bytes data;
};

Question draw(std::mt19937& random) {
    const auto below = [&](unsigned n) { return std::uniform_int_distribution<unsigned>{0, n - 1}(random); };
    // Without BRW: what a slave writes there depends on what those before it read (docs/ring.md).
    constexpr std::array commands{Command::APRD, Command::APWR, Command::APRW, Command::FPRD, Command::FPWR, Command::FPRW,
                                  Command::BRD,  Command::BWR,  Command::LRD,  Command::LWR,  Command::LRW,  Command::NOP};
    Question q;
    q.command = commands[below(commands.size())];
    const auto ado = static_cast<std::uint16_t>(ram + 0x100 * below(2) + below(8));
    const auto somebody = static_cast<std::uint16_t>(below(line_of + 1));  // or nobody
    const bool logical = q.command == Command::LRD || q.command == Command::LWR || q.command == Command::LRW;
    const bool by_position = q.command == Command::APRD || q.command == Command::APWR || q.command == Command::APRW;
    const bool all = q.command == Command::BRD || q.command == Command::BWR;
    q.address = logical       ? Address::logical(below(logical_a_slave * line_of))
                : by_position ? Address::position(somebody, ado)
                : all         ? Address::physical(0, ado)
                              : Address::physical(static_cast<std::uint16_t>(0x1001 + somebody), ado);
    q.data.resize(1 + below(logical ? 40 : 12));
    const bool reads = q.command == Command::LRD || q.command == Command::BRD;
    for (auto& byte : q.data) byte = reads ? std::byte{0} : static_cast<std::byte>(below(256));
    return q;
}

TEST(FrameMerge, AnswersAsTheWholeLine) {
    std::size_t by_halves = 0;
    for (std::size_t run = 0; run < property_cases(20); ++run) {
        std::mt19937 random{static_cast<unsigned>(run)};
        sim::SimNetwork line{Instant{}};
        for (std::size_t s = 0; s < line_of; ++s) line.add(bare_slave(), std::make_unique<Idle>());
        RingProbe ring{line_of};
        map_logical(line);
        map_logical(ring.network);
        LoopbackTransport cable{line};
        std::size_t broken = line_of + 1;
        for (int i = 0; i < 300; ++i) {
            if (random() % 10 == 0) {
                if (broken <= line_of) ring.cable(broken, true);
                broken = random() % (line_of + 2);
                if (broken <= line_of) ring.cable(broken, false);
                // So many frames until it is believed that the first interface reaches nobody, and positions count from the second one's.
                for (int frames = 0; frames < 8; ++frames) ASSERT_EQ(ring.count()->wkc, line_of);
            }
            const auto q = draw(random);
            std::array<std::byte, max_frame_size> buffer{};
            FrameBuilder builder{buffer, cable.mac()};
            const auto area = builder.add(q.command, 1, q.address, q.data.size());
            std::copy(q.data.begin(), q.data.end(), area.begin());
            ASSERT_TRUE(cable.send(builder.finish(), ring.now));
            const auto expected = ring.ask(q.command, q.address, q.data);
            const auto received = cable.receive(buffer, ring.now);
            ASSERT_TRUE(received && expected);
            FrameReader reader{std::span<const std::byte>{buffer}.first(received->size)};
            const auto datagram = reader.next();
            const RingProbe::Answer whole{datagram->working_counter(), datagram->address.adp(),
                                          Bytes(datagram->data.begin(), datagram->data.end())};
            ASSERT_EQ(*expected, whole) << "run " << run << ", frame " << i << ", command " << name(q.command) << ", break " << broken;
            by_halves += broken > 0 && broken < line_of ? 1 : 0;
        }
        for (std::uint16_t s = 0; s < line_of; ++s)
            for (std::uint16_t at = ram; at < ram + 0x110; ++at)
                ASSERT_EQ(ring.network.slave(s).controller().peek(at), line.slave(s).controller().peek(at)) << "slave " << s;
        EXPECT_EQ(ring.answers_too_many, 0);
    }
    EXPECT_GT(by_halves, 1000u) << "or nothing was merged here";
}

}  // namespace
}  // namespace taktwerk::ecat::test
