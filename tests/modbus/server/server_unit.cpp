// The server among its clients: good ones, half ones, slow ones, hostile ones. Real sockets on loopback; time is handed in.
#include "modbus/server/server.hpp"

#include <atomic>
#include <thread>

#include <gmock/gmock.h>

#include "core/clock.hpp"
#include "tests/modbus/server/raw_client.hpp"

namespace taktwerk::modbus::server {
namespace {

using namespace std::chrono_literals;
using ::testing::ElementsAre;
using testing::framed;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::RawBytes;
using testing::RawClient;
using testing::ServedRig;

const RawBytes read_position{4, 0, 0, 0, 2}, set_speed{6, 0, 0, 0, 55}, both_coils{15, 0, 0, 0, 2, 1, 0x02};

/// -12.5 is C148 0000h.
RawBytes position_answer(std::uint8_t transaction = 1) { return framed({4, 4, 0xC1, 0x48, 0, 0}, transaction); }
RawBytes refused(std::uint8_t function, Exception exception, std::uint8_t transaction = 1, std::uint8_t unit = 1) {
    return framed({static_cast<std::uint8_t>(function | 0x80), static_cast<std::uint8_t>(exception)}, transaction, unit);
}

ServerConfig at(const char* host, std::uint16_t port) {
    ServerConfig config;
    config.listen = {host, port};
    return config;
}

TEST(ModbusServer, AClientReadsWhatTheMachineSaidLast) {
    ServedRig rig;
    RawClient client{rig.server->port()};
    EXPECT_EQ(rig.ask(client, framed(read_position)), position_answer());
    rig.publish({1, 8, 0, 0, 0});
    EXPECT_EQ(rig.ask(client, framed({4, 0, 0, 0, 3}, 2)), framed({4, 6, 0x3F, 0x80, 0, 0, 0, 8}, 2)) << "all of the same cycle";
}

TEST(ModbusServer, ItsUnitAndThoseOfNoGatewayAreAnswered) {
    ServedRig rig;
    RawClient client{rig.server->port()};
    for (const auto unit : RawBytes{1, 0, 255}) EXPECT_EQ(rig.ask(client, framed({4, 0, 2, 0, 1}, 1, unit)), framed({4, 2, 0, 7}, 1, unit));
    EXPECT_EQ(rig.ask(client, framed({4, 0, 2, 0, 1}, 1, 2)), refused(4, Exception::no_such_unit, 1, 2));
}

// The oldest that is answered is `max_age`; one nanosecond more is too old.
TEST(ModbusServer, AnImageThatIsTooOldIsNotAnswered) {
    ServedRig rig;
    RawClient client{rig.server->port()};
    const auto at = rig.now;
    rig.now = at + 200ms;
    EXPECT_EQ(rig.ask(client, framed(read_position)), position_answer());
    rig.now = at + 200ms + 1ns;
    EXPECT_EQ(rig.ask(client, framed(read_position)), refused(4, Exception::server_failure));
    EXPECT_EQ(rig.ask(client, framed({2, 0, 0, 0, 1})), refused(2, Exception::illegal_address)) << "that it never had";
    EXPECT_EQ(rig.ask(client, framed(set_speed)), refused(6, Exception::server_failure));
    EXPECT_FALSE(rig.server->orders().next_order()) << "nothing is commanded blindly";
    rig.publish({-12.5, 7, 0, 0, 0});
    EXPECT_EQ(rig.ask(client, framed(read_position)), position_answer());
}

TEST(ModbusServer, BeforeTheFirstCycleNothingIsAnswered) {
    auto opened = Server::open(at("127.0.0.1", 0), {ServedRegister{}});
    ASSERT_TRUE(opened);
    ServedRig rig;
    rig.server = std::move(opened).value();
    RawClient client{rig.server->port()};
    EXPECT_EQ(rig.ask(client, framed({4, 0, 0, 0, 1})), refused(4, Exception::server_failure));
}

TEST(ModbusServer, AFrameMayComeByteByByteAndSeveralAtOnce) {
    ServedRig rig;
    RawClient client{rig.server->port()};
    const auto frame = framed(read_position);
    for (std::size_t i = 0; i + 1 < frame.size(); ++i) {
        client.send({frame[i]});
        rig.step();
        EXPECT_THAT(client.take(), IsEmpty());
    }
    EXPECT_EQ(rig.ask(client, {frame.back()}), position_answer());

    RawBytes three = framed(read_position, 2), answers;
    for (const auto& more : {framed({4, 0, 9, 0, 1}, 3), framed(read_position, 4)}) three.insert(three.end(), more.begin(), more.end());
    client.send(three);
    rig.until([&] {
        const auto more = client.take();
        answers.insert(answers.end(), more.begin(), more.end());
        return answers.size() >= 13 + 9 + 13;
    });
    auto expected = position_answer(2);
    for (const auto& more : {refused(4, Exception::illegal_address, 3), position_answer(4)})
        expected.insert(expected.end(), more.begin(), more.end());
    EXPECT_EQ(answers, expected) << "in their order";
}

// --- writes -----------------------------------------------------------------------------------------------------------------------------

TEST(ModbusServer, AWriteIsAnsweredWhenTheMachineHasJudgedIt) {
    ServedRig rig;
    RawClient client{rig.server->port()}, other{rig.server->port()};
    client.send(framed(set_speed, 5));
    std::optional<WriteOrder> order;
    ASSERT_TRUE(rig.until([&] { return (order = rig.server->orders().next_order()).has_value(); }));
    EXPECT_EQ(order->at, rig.now);
    ASSERT_EQ(order->changes.size(), 1u);
    EXPECT_EQ(order->changes[0].index, 2u);
    EXPECT_EQ(order->changes[0].number, 55);
    EXPECT_THAT(order->who, HasSubstr("127.0.0.1:"));
    EXPECT_EQ(rig.ask(other, framed(read_position)), position_answer()) << "meanwhile";
    EXPECT_THAT(client.take(), IsEmpty());
    rig.server->orders().judge({order->id, Exception::none});
    EXPECT_EQ(rig.ask(client, {}), framed(set_speed, 5)) << "the echo";
}

TEST(ModbusServer, AVerdictGoesToWhoseOrderItIs) {
    ServedRig rig;
    RawClient first{rig.server->port()}, second{rig.server->port()};
    std::optional<WriteOrder> orders[2];
    for (auto* client : {&first, &second}) {
        client->send(framed(set_speed));
        auto& order = orders[client == &first ? 0 : 1];
        ASSERT_TRUE(rig.until([&] { return (order = rig.server->orders().next_order()).has_value(); }));
    }
    rig.server->orders().judge({orders[1]->id, Exception::illegal_value});
    EXPECT_EQ(rig.ask(second, {}), refused(6, Exception::illegal_value));
    EXPECT_THAT(first.take(), IsEmpty());
    rig.server->orders().judge({orders[0]->id, Exception::none});
    EXPECT_EQ(rig.ask(first, {}), framed(set_speed));
}

TEST(ModbusServer, SeveralCoilsAreOneOrder) {
    ServedRig rig;
    RawClient client{rig.server->port()};
    client.send(framed(both_coils));
    std::optional<WriteOrder> order;
    ASSERT_TRUE(rig.until([&] { return (order = rig.server->orders().next_order()).has_value(); }));
    ASSERT_EQ(order->changes.size(), 2u);
    EXPECT_EQ(order->changes[0].number, 0);
    EXPECT_EQ(order->changes[1].index, 4u);
    EXPECT_EQ(order->changes[1].number, 1);
    rig.server->orders().judge({order->id, Exception::server_failure});
    EXPECT_EQ(rig.ask(client, {}), refused(15, Exception::server_failure));
}

TEST(ModbusServer, AMachineThatDoesNotJudgeIsAFailure) {
    ServedRig rig;
    RawClient client{rig.server->port()};
    client.send(framed(set_speed));
    std::optional<WriteOrder> order;
    ASSERT_TRUE(rig.until([&] { return (order = rig.server->orders().next_order()).has_value(); }));
    rig.now += Server::order_patience + 1ns;
    EXPECT_EQ(rig.ask(client, {}), refused(6, Exception::server_failure));
    rig.server->orders().judge({order->id, Exception::none});
    rig.publish({-12.5, 7, 0, 0, 0});
    EXPECT_EQ(rig.ask(client, framed(read_position, 9)), position_answer(9)) << "a verdict that comes later is no answer to anything";
}

TEST(ModbusServer, TheMachineHearsThatWhoHasWrittenIsGone) {
    ServedRig rig;
    std::optional<WriteOrder> order;
    {
        RawClient reader{rig.server->port()}, writer{rig.server->port()};
        EXPECT_EQ(rig.ask(reader, framed(read_position)), position_answer());
        writer.send(framed(set_speed));
        ASSERT_TRUE(rig.until([&] { return (order = rig.server->orders().next_order()).has_value(); }));
        rig.server->orders().judge({order->id, Exception::none});
        rig.ask(writer, {});
    }
    ASSERT_TRUE(rig.until([&] { return rig.server->client_count() == 0; }));
    EXPECT_EQ(rig.server->orders().next_gone(), std::optional{order->connection});
    EXPECT_FALSE(rig.server->orders().next_gone()) << "who only reads is nobody's business";
}

// --- clients that are no good -----------------------------------------------------------------------------------------------------------

TEST(ModbusServer, WhoAsksNothingForTooLongIsLetGo) {
    ServedRig rig;
    RawClient busy{rig.server->port()}, silent{rig.server->port()}, half{rig.server->port()}, dribbling{rig.server->port()};
    rig.until([&] { return rig.server->client_count() == 4; });
    half.send({0, 1, 0, 0, 0});
    const auto frame = framed(read_position);
    const RawBytes endless(250, 0);
    for (int second = 0; second <= 10; ++second) {
        rig.publish({-12.5, 7, 0, 0, 0});
        EXPECT_EQ(rig.ask(busy, frame), position_answer()) << "in second " << second;
        dribbling.send({second == 5 ? std::uint8_t{254} : std::uint8_t{0}});  // the header of a long frame, then zeros
        EXPECT_EQ(rig.server->client_count(), 4u);
        rig.now += 1s;
    }
    rig.publish({-12.5, 7, 0, 0, 0});
    EXPECT_EQ(rig.ask(busy, frame), position_answer());
    EXPECT_EQ(rig.server->client_count(), 1u);
    EXPECT_TRUE(silent.ended() && half.ended() && dribbling.ended());
    EXPECT_FALSE(busy.ended());
}

TEST(ModbusServer, MoreThanItsPlacesAreSentAwayAndTheOthersStay) {
    ServerConfig three;
    three.clients = 3;
    ServedRig rig{three};
    std::vector<std::unique_ptr<RawClient>> good, late;
    for (int i = 0; i < 3; ++i) good.push_back(std::make_unique<RawClient>(rig.server->port()));
    rig.until([&] { return rig.server->client_count() == 3; });
    for (int i = 0; i < 40; ++i) {
        late.push_back(std::make_unique<RawClient>(rig.server->port()));
        rig.step();
    }
    EXPECT_TRUE(rig.until([&] { return late.back()->ended(); }));
    for (auto& client : good) EXPECT_EQ(rig.ask(*client, framed(read_position)), position_answer());
    EXPECT_EQ(rig.server->client_count(), 3u);
    ASSERT_EQ(rig.log.size(), 1u) << "however many they are";
    EXPECT_THAT(rig.log[0], HasSubstr("all 3 places are taken"));
    good.pop_back();
    rig.until([&] { return rig.server->client_count() == 2; });
    RawClient next{rig.server->port()};
    EXPECT_EQ(rig.ask(next, framed(read_position)), position_answer()) << "its place is free";
}

// What it does not read stays in its own buffers: some dozens of answers, then it is not asked any more.
TEST(ModbusServer, AClientThatNeverReadsHoldsUpNobodyAndIsLetGo) {
    ServedRig rig;
    RawClient greedy{rig.server->port(), 2048}, late{rig.server->port(), 2048}, good{rig.server->port()};
    RawBytes numbered;  // transactions 0 to 255, and again
    for (int i = 0; i < 256; ++i) {
        const auto one = framed({4, 0, 0, 0, 3}, static_cast<std::uint8_t>(i));
        numbered.insert(numbered.end(), one.begin(), one.end());
    }
    std::size_t taken[2] = {0, 0}, quiet = 0;
    const auto send_on = [&](RawClient& client, std::size_t& sent) {
        const auto more = client.send({numbered.begin() + static_cast<std::ptrdiff_t>(sent % numbered.size()), numbered.end()});
        sent += more;
        return more;
    };
    for (Patience patience{100'000}; patience.lasts(quiet < 200);) {
        const auto first = send_on(greedy, taken[0]);
        const auto second = send_on(late, taken[1]);
        quiet = first + second == 0 ? quiet + 1 : 0;
        rig.step();
    }
    EXPECT_EQ(rig.ask(good, framed(read_position)), position_answer());
    EXPECT_LT(taken[0] + taken[1], 32u << 20) << "bounded by the sockets";

    // When the second reads at last, what lay there are whole answers, and it is served again.
    RawBytes heard;
    rig.now += 6s;
    rig.publish({-12.5, 7});
    for (int i = 0; i < 500; ++i) {
        const auto more = late.take();
        heard.insert(heard.end(), more.begin(), more.end());
        rig.step();
    }
    const std::size_t whole = framed({4, 6, 0xC1, 0x48, 0, 0, 0, 7}).size();
    EXPECT_GT(heard.size(), 200 * whole);
    for (std::size_t i = 0; (i + 1) * whole <= heard.size(); ++i)
        ASSERT_EQ(
            RawBytes(heard.begin() + static_cast<std::ptrdiff_t>(i * whole), heard.begin() + static_cast<std::ptrdiff_t>((i + 1) * whole)),
            framed({4, 6, 0xC1, 0x48, 0, 0, 0, 7}, static_cast<std::uint8_t>(i % 256)))
            << "answer " << i << ": none is missing";

    rig.now += 6s;
    rig.publish({-12.5, 7});
    rig.step();
    EXPECT_EQ(rig.server->client_count(), 1u) << "the first is gone, and the good one, which was silent";
    EXPECT_FALSE(late.ended());
}

TEST(ModbusServer, AFloodLeavesTheOthersTheirTurn) {
    ServedRig rig;
    RawClient flood{rig.server->port()}, good{rig.server->port()};
    rig.until([&] { return rig.server->client_count() == 2; });
    RawBytes many;
    for (int i = 0; i < 1000; ++i) {
        const auto one = framed(read_position);
        many.insert(many.end(), one.begin(), one.end());
    }
    flood.send(many);
    good.send(framed(read_position, 7));
    rig.step();
    EXPECT_EQ(good.take(), position_answer(7)) << "in the same step";
    EXPECT_LE(flood.take().size(), Server::requests_per_step * position_answer().size());
}

TEST(ModbusServer, WhatIsNoModbusEndsItsOwnConnectionOnly) {
    ServedRig rig;
    RawClient good{rig.server->port()};
    for (int i = 0; i < 50; ++i) {
        RawClient browser{rig.server->port()};
        browser.send({'G', 'E', 'T', ' ', '/', '\r', '\n'});
        EXPECT_TRUE(rig.until([&] { return browser.ended(); }));
        EXPECT_THAT(browser.take(), IsEmpty());
    }
    EXPECT_EQ(rig.ask(good, framed(read_position)), position_answer());
    ASSERT_EQ(rig.log.size(), 1u);
    EXPECT_THAT(rig.log[0], HasSubstr("no Modbus TCP"));
}

/// Numbers as from a seed, without a library whose order could change.
class Drawn {
public:
    explicit Drawn(std::uint64_t seed) : state_(seed) {}
    std::uint8_t byte() {
        state_ = state_ * 6364136223846793005u + 1442695040888963407u;
        return static_cast<std::uint8_t>(state_ >> 56);
    }

private:
    std::uint64_t state_;
};

// Each frame has one answer, with its transaction and unit, which is either what was read, an echo, or an exception of the five.
TEST(ModbusServer, TenThousandRandomFramesEachHaveOneAnswer) {
    ServedRig rig;
    RawClient hostile{rig.server->port()}, good{rig.server->port()};
    Drawn drawn{20240611};
    int refusals = 0, orders = 0;
    for (int i = 0; i < 10'000; ++i) {
        RawBytes pdu(1 + drawn.byte() % 12u);
        for (auto& byte : pdu) byte = drawn.byte();
        if (drawn.byte() % 2 == 0) pdu[0] = static_cast<std::uint8_t>(1 + pdu[0] % 16);  // a function that is there, mostly
        if (drawn.byte() % 2 == 0 && pdu.size() > 4) {                                   // few addresses, few of them
            pdu[1] = pdu[3] = 0;
            pdu[2] = static_cast<std::uint8_t>(pdu[2] % 4);
            pdu[4] = static_cast<std::uint8_t>(pdu[4] % 4);
            if (drawn.byte() % 2 == 0) pdu.resize(5);
        }
        const auto transaction = drawn.byte();
        const auto unit = static_cast<std::uint8_t>(drawn.byte() % 3);
        hostile.send(framed(pdu, transaction, unit));
        RawBytes answer;
        const bool came = rig.until([&] {
            while (const auto order = rig.server->orders().next_order()) {
                ++orders;
                for (const auto& change : order->changes) EXPECT_TRUE(rig.registers[change.index].writable);
                rig.server->orders().judge({order->id, Exception::none});
            }
            const auto more = hostile.take();
            answer.insert(answer.end(), more.begin(), more.end());
            return answer.size() >= 9 && answer.size() >= 6u + answer[5];
        });
        ASSERT_TRUE(came) << i;
        ASSERT_EQ(answer.size(), 6u + answer[5]) << i;
        EXPECT_THAT(RawBytes(answer.begin(), answer.begin() + 4), ElementsAre(0, transaction, 0, 0));
        EXPECT_EQ(answer[4], 0);
        EXPECT_EQ(answer[6], unit);
        EXPECT_EQ(answer[7] & 0x7F, pdu[0] & 0x7F);
        if ((answer[7] & 0x80) == 0) continue;
        ++refusals;
        EXPECT_EQ(answer.size(), 9u);
        EXPECT_TRUE((answer[8] >= 1 && answer[8] <= 4) || answer[8] == 11) << int{answer[8]};
    }
    EXPECT_GT(refusals, 5000);
    EXPECT_LT(refusals, 10'000) << "some were good by chance";
    EXPECT_GT(orders, 0);
    EXPECT_EQ(rig.ask(good, framed(read_position)), position_answer());
}

TEST(ModbusServer, TenThousandTimesAnyBytesDisturbNobody) {
    ServedRig rig;
    RawClient good{rig.server->port()};
    Drawn drawn{7};
    auto hostile = std::make_unique<RawClient>(rig.server->port());
    int ended = 0;
    for (int i = 0; i < 10'000; ++i) {
        RawBytes any(drawn.byte());
        for (auto& byte : any) byte = drawn.byte();
        if (drawn.byte() % 4 == 0 && any.size() > 5) any[2] = any[3] = any[4] = 0;  // a header that could be one
        hostile->send(any);
        rig.step();
        if (hostile->ended()) {
            ++ended;
            hostile = std::make_unique<RawClient>(rig.server->port());
        }
        while (const auto order = rig.server->orders().next_order()) rig.server->orders().judge({order->id, Exception::none});
        if (i % 100 == 0) {
            EXPECT_EQ(rig.ask(good, framed(read_position)), position_answer()) << i;
        }
    }
    EXPECT_GT(ended, 1000);
    EXPECT_EQ(rig.ask(good, framed(read_position)), position_answer());
}

// --- the thread and its end -----------------------------------------------------------------------------------------------------------

TEST(ModbusServer, WaitingEndsWhenSomethingComesOrTheTimeHasPassed) {
    ServedRig rig;
    SystemClock clock;
    const auto start = clock.now();
    rig.server->wait(30ms);
    EXPECT_GE(clock.now() - start, 29ms);
    RawClient client{rig.server->port()};
    for (Patience patience; patience.lasts(rig.server->client_count() == 0);) {
        rig.server->wait(20s);  // the test would take that long
        rig.step();
    }
    client.send(framed(read_position));
    for (RawBytes answer; answer.empty(); answer = client.take()) {
        rig.server->wait(20s);
        rig.step();
    }
    RawBytes many, answers;
    for (int i = 0; i < 40; ++i) {
        const auto one = framed(read_position);
        many.insert(many.end(), one.begin(), one.end());
    }
    client.send(many);  // more than one step answers: nothing further comes, and all the same nobody waits
    for (Patience patience; patience.lasts(answers.size() < 40 * position_answer().size());) {
        rig.server->wait(20s);
        rig.step();
        const auto more = client.take();
        answers.insert(answers.end(), more.begin(), more.end());
    }
    EXPECT_LT(clock.now() - start, 10s);
}

// The machine's side, the server and two clients, each on a thread of its own: what is read together is of one cycle, whatever the others do. Its worth
// is also under the thread sanitizer.
TEST(ModbusServer, WhatIsReadTogetherIsOfOneCycle) {
    ServedRig rig;
    SystemClock clock;
    std::atomic<bool> ended{false};
    std::thread machine{[&] {
        for (std::uint16_t cycle = 0; !ended.load(); ++cycle) {
            rig.now = clock.now();
            rig.publish({static_cast<double>(cycle), static_cast<double>(cycle), 0, 0, 0});
            while (const auto order = rig.server->orders().next_order()) rig.server->orders().judge({order->id, Exception::none});
            while (rig.server->orders().next_gone()) {}
        }
    }};
    std::thread server{[&] {
        SystemClock own;
        while (!ended.load()) {
            rig.server->wait(20ms);
            rig.server->step(own.now());
        }
    }};
    const auto ask = [](RawClient& client, const RawBytes& frame) {
        client.send(frame);
        RawBytes answer;
        for (auto patience = Patience::of_threads(); patience.lasts(answer.size() < 7 || answer.size() < 6u + answer[5]);) {
            const auto more = client.take();
            answer.insert(answer.end(), more.begin(), more.end());
            std::this_thread::yield();
        }
        return answer;
    };
    // On a busy computer the machine may get no time for longer than its numbers stay fresh: then nothing is told, but exception 4.
    const auto too_late = [](const RawBytes& answer) { return answer.size() == 9 && (answer[7] & 0x80) != 0 && answer[8] == 4; };
    int different = 0, told = 0, taken = 0;
    std::thread writer{[&] {
        RawClient client{rig.server->port()};
        for (int i = 0; i < 300; ++i) {
            const auto answer = ask(client, framed(set_speed));
            if (too_late(answer)) continue;
            EXPECT_EQ(answer, framed(set_speed));
            ++taken;
        }
    }};
    {
        RawClient client{rig.server->port()};
        std::uint16_t last = 0;
        for (int i = 0; i < 3000; ++i) {
            const auto answer = ask(client, framed({4, 0, 0, 0, 3}));
            if (too_late(answer)) continue;
            EXPECT_EQ(answer.size(), 15u);
            if (answer.size() != 15u) break;  // the threads want to be joined
            ++told;
            const auto word = [&](std::size_t at) { return static_cast<std::uint16_t>(answer[at] << 8 | answer[at + 1]); };
            ServedRegister real;
            real.type = NumberType::float32;
            EXPECT_EQ(number_of(real, {word(9), word(11)}), word(13));
            different += word(13) != last ? 1 : 0;
            last = word(13);
        }
    }
    writer.join();
    ended.store(true);
    machine.join();
    server.join();
    EXPECT_GT(told, 1500);
    EXPECT_GT(taken, 150);
    EXPECT_GT(different, 100) << "cycles went on meanwhile";
}

// 8 clients that flood, one that never reads, half frames: the thread ends as soon as it is told to.
TEST(ModbusServer, TheThreadEndsWhateverItsClientsDo) {
    ServedRig rig;
    std::atomic<bool> ended{false}, over{false};
    std::thread server{[&] {
        SystemClock clock;
        while (!ended.load()) {
            rig.server->wait(20ms);
            rig.server->step(clock.now());
        }
        over.store(true);
    }};
    std::vector<std::unique_ptr<RawClient>> clients;
    for (int i = 0; i < 8; ++i) clients.push_back(std::make_unique<RawClient>(rig.server->port(), 2048));
    const auto frame = framed(read_position);
    for (int round = 0; round < 2000; ++round)
        for (auto& client : clients) client->send(frame);
    SystemClock clock;
    const auto told = clock.now();
    ended.store(true);
    server.join();
    EXPECT_TRUE(over.load());
    EXPECT_LT(clock.now() - told, 2s) << "20 ms, and as long as this computer is busy with others";
    rig.server.reset();
    for (auto& client : clients) {
        bool gone = false;
        for (Patience patience; patience.lasts(!gone);) gone = client->ended();
    }
}

TEST(ModbusServer, AnAddressThatIsTakenOrNobodysSaysWhatToDo) {
    ServedRig rig;
    const auto taken = Server::open(at("127.0.0.1", rig.server->port()), {});
    ASSERT_FALSE(taken);
    EXPECT_EQ(taken.error().code, "served.listen");
    EXPECT_THAT(taken.error().text(), HasSubstr("another process listens there"));
    const auto foreign = Server::open(at("192.0.2.1", 1502), {});  // TEST-NET-1: nobody's
    ASSERT_FALSE(foreign);
    EXPECT_THAT(foreign.error().text(), HasSubstr("no network port of this computer has this address"));
}

}  // namespace
}  // namespace taktwerk::modbus::server
