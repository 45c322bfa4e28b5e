// A jog over the real server, before a real machine: whatever dies or stands still between the finger and the cycle, the axis stands within lease and ramp.
// Positions are those of the machine's own socket. Times are the machine's: its lease counts cycles.

#include <csignal>

#include <functional>
#include <optional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/apps/hmi/quiet_machine.hpp"
#include "tests/hmi_bridge/web/page_client.hpp"

namespace taktwerk::apps {
namespace {

using namespace std::chrono_literals;
using hmi::web::PageClient;
using hmi::web::PageJson;

constexpr double velocity = 20;   // mm/s: the demo's `manual: slow`
constexpr double lease_s = 0.25;  // hmi_bridge/README.md: a jog without valid_ms
// 5000 mm/s2 and 100000 mm/s3: 20 mm/s are gone within sqrt(4 * 20 / 100000) = 28 ms.
constexpr double ramp_s = 0.03;

class LostHand : public ::testing::Test {
protected:
    void SetUp() override {
        if (!page_is_built()) GTEST_SKIP() << "the page is not built (no npm, or TAKTWERK_PAGE=OFF)";
        machine_.emplace(std::vector<std::string>{"--hmi=127.0.0.1:0"});
        ASSERT_NE(machine_->port(), 0) << machine_->child->text();
        ASSERT_GE(machine_->cycle(20s), 0) << machine_->child->text();
        auto client = hmi::Client::connect(machine_->socket());
        ASSERT_TRUE(client);
        own_.emplace(std::move(*client));
        ASSERT_TRUE(page_.open(machine_->port()));
        ASSERT_FALSE(page_.next([](const PageJson& one) { return one.value("type", "") == "state"; }, 10s).is_null());
        for (const auto until = std::chrono::steady_clock::now() + 20s;
             std::chrono::steady_clock::now() < until && !x()["powered"].get<bool>();) {
            (void)page_.ask({{"cmd", "enable"}, {"axis", "x"}});
            ::usleep(200'000);
        }
        ASSERT_TRUE(x()["powered"].get<bool>()) << machine_->child->text();
    }
    nlohmann::ordered_json x() {
        const auto answer = own_->request({{"cmd", "state"}});
        if (!answer) return {};
        time_s_ = (*answer)["state"]["time_ns"].get<double>() * 1e-9;
        return (*answer)["state"]["axes"][0];
    }
    double position() { return x()["actual_position"].get<double>(); }
    void renew(bool press = false) {
        PageJson jog{{"cmd", "jog"}, {"axis", "x"}, {"velocity", velocity}};
        if (press) jog["press"] = true;
        page_.command(std::move(jog));
    }
    /// Pressed and held until the axis has gone 15 mm: three times as far as one lease carries it.
    void jog() {
        renew(true);
        const auto from = position();
        for (const auto until = std::chrono::steady_clock::now() + 20s; position() < from + 15;) {
            ASSERT_LT(std::chrono::steady_clock::now(), until) << x().dump();
            ::usleep(40'000);
            renew();
        }
    }
    /// From now on nothing is renewed: by when it stands, and how far it has gone at most.
    void stands_within_lease_and_ramp() {
        const auto from = position();
        const auto at_s = time_s_;
        auto axis = x();
        while (axis["set_velocity"].get<double>() != 0 && time_s_ < at_s + 5) axis = x();
        EXPECT_EQ(axis["set_velocity"].get<double>(), 0);
        // What had been sent before may have been under way: half a second for a busy computer, which a lease that is not there would not keep.
        EXPECT_LT(time_s_ - at_s, lease_s + ramp_s + 0.5);
        EXPECT_LT(axis["actual_position"].get<double>() - from, velocity * (lease_s + ramp_s + 0.5));
        const auto stood = axis["set_position"].get<double>();
        ::usleep(500'000);
        EXPECT_EQ(x()["set_position"].get<double>(), stood) << "and stays there";
    }

    std::optional<QuietMachine> machine_;
    std::optional<hmi::Client> own_;
    PageClient page_;
    double time_s_ = 0;  ///< machine time of the last x()
};

TEST_F(LostHand, DeadSocket) {
    jog();
    page_.close();
    stands_within_lease_and_ramp();
}

TEST_F(LostHand, FrozenPage) {
    jog();
    stands_within_lease_and_ramp();  // its connection stands, it says nothing
    // A renewal without a new press moves nothing.
    const auto stood = x()["set_position"].get<double>();
    renew();
    ::usleep(200'000);
    EXPECT_EQ(x()["set_position"].get<double>(), stood);
}

TEST_F(LostHand, FrozenServerAndNothingIsReplayedWhenItGoesOn) {
    jog();
    const auto server = QuietMachine::child_of(machine_->child->pid());
    ASSERT_GT(server, 1);
    ASSERT_EQ(::kill(server, SIGSTOP), 0);
    const auto at = PageClient::now_ms();
    // The finger stays on the button for half a second: it all waits in the server's socket.
    for (int i = 0; i < 10; ++i) page_.command({{"cmd", "jog"}, {"axis", "x"}, {"velocity", velocity}, {"sent_ms", at + 50 * i}});
    page_.command({{"cmd", "jog"}, {"axis", "x"}, {"velocity", velocity}, {"press", true}, {"sent_ms", at + 500}});
    stands_within_lease_and_ramp();
    // On a busy computer the lease may have run out before the freeze: the press of 500 ms has to be older than a jog may be (message_age.hpp) in any case.
    while (PageClient::now_ms() < at + 900) ::usleep(10'000);
    const auto stood = x()["set_position"].get<double>();
    ASSERT_EQ(::kill(server, SIGCONT), 0);
    const auto refused = page_.next(
        [](const PageJson& one) {
            return one.value("type", "") == "answer" && one.contains("error") && one["error"]["code"] == "web.too_old";
        },
        5s);
    EXPECT_FALSE(refused.is_null());
    ::usleep(500'000);
    EXPECT_EQ(x()["set_position"].get<double>(), stood);
}

TEST_F(LostHand, KilledServer) {
    jog();
    const auto server = QuietMachine::child_of(machine_->child->pid());
    ASSERT_GT(server, 1);
    ASSERT_EQ(::kill(server, SIGKILL), 0);
    stands_within_lease_and_ramp();
}

}  // namespace
}  // namespace taktwerk::apps
