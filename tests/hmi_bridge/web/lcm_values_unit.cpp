// A page's values over LCM: real multicast in a network of the test's own, a machine's bridge on one thread, the page's server on another.

#include <gmock/gmock.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <memory>
#include <thread>

#include <nlohmann/json.hpp>

#include "hmi_bridge/hmi_bridge.hpp"
#include "hmi_bridge/lcm/lcm_bus.hpp"
#include "hmi_bridge/web/lcm_offer.hpp"
#include "hmi_bridge/web/server/web_server.hpp"
#include "tests/hmi_bridge/fake_machine.hpp"
#include "tests/hmi_bridge/own_network.hpp"
#include "tests/hmi_bridge/web/page_client.hpp"

namespace taktwerk::hmi::web {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

class Folder {
public:
    Folder() {
        auto pattern = (std::filesystem::temp_directory_path() / "taktwerk-lcm-XXXXXX").string();
        path_ = ::mkdtemp(pattern.data());
        std::filesystem::create_directory(path_ / "page");
        std::ofstream(path_ / "page" / "index.html") << "<!doctype html><title>page</title>";
    }
    ~Folder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    [[nodiscard]] std::string socket() const { return (path_ / "demo.sock").string(); }
    [[nodiscard]] std::string page() const { return (path_ / "page").string(); }

private:
    std::filesystem::path path_;
};

/// A machine that cycles, with its bridge, on a thread of its own.
class Runtime {
public:
    Runtime(HmiConfig config, double set_position) {
        machine_.snapshot.axes[0].set_position = set_position;
        auto opened = HmiBridge::open(config, machine_, {});
        if (!opened) return;
        bridge_ = std::move(*opened);
        thread_ = std::thread([this] {
            for (Instant at{1s}; !ends_; at += 5ms) {
                ++machine_.snapshot.cycle;
                machine_.snapshot.at += 5ms;
                bridge_->step(at);
                bridge_->door().wait(5ms);
            }
        });
    }
    ~Runtime() {
        ends_ = true;
        if (thread_.joinable()) thread_.join();
    }
    Runtime(const Runtime&) = delete;
    Runtime& operator=(const Runtime&) = delete;
    [[nodiscard]] bool runs() const { return bridge_ != nullptr; }

private:
    test::FakeMachine machine_;
    std::unique_ptr<HmiBridge> bridge_;
    std::atomic<bool> ends_{false};
    std::thread thread_;
};

class Served {
public:
    Served(const Folder& folder, ValueSource source) {
        ServerOptions options;
        options.port = 0;
        options.machines = {folder.socket()};
        options.source = source;
        auto opened = WebServer::open(options, *SiteFiles::load(folder.page()));
        if (!opened) return;
        server_ = std::move(*opened);
        thread_ = std::thread([this] { server_->run(); });
        open_ = page.open(server_->port());
    }
    ~Served() {
        if (server_) server_->stop();
        if (thread_.joinable()) thread_.join();
    }
    Served(const Served&) = delete;
    Served& operator=(const Served&) = delete;
    [[nodiscard]] bool open() const { return open_; }
    /// Until the page is told that its values come from there; what it is told, or null.
    PageJson told(const std::string& source) {
        return page.next([&](const PageJson& one) { return one.value("type", "") == "hello" && one.value("source", "") == source; }, 20s);
    }
    /// The next state whose axis x is there; null: none.
    PageJson state_at(double set_position) {
        return page.next(
            [&](const PageJson& one) {
                return one.value("type", "") == "state" && one["state"]["axes"][0]["set_position"] == set_position;
            },
            20s);
    }

    PageClient page;

private:
    std::unique_ptr<WebServer> server_;
    std::thread thread_;
    bool open_ = false;
};

HmiConfig config_at(const Folder& folder) {
    HmiConfig config;
    config.socket = folder.socket();
    return config;
}

TEST(LcmValues, ComeOverLcmAndFollowAMachineThatIsStartedAgain) {
    RUN_IN_OWN_NETWORK([]() -> std::string {
        if (!test::multicast_on()) return "skip";
        const Folder folder;
        auto runtime = std::make_unique<Runtime>(config_at(folder), 12.5);
        Served served{folder, ValueSource::automatic};
        if (!runtime->runs() || !served.open()) return "does not run";
        const auto hello = served.told("lcm");
        if (hello.is_null()) return "the page was never told that its values come over LCM";
        if (hello["why_not_lcm"] != "") return "it works, and says why not: " + hello["why_not_lcm"].get<std::string>();
        const auto first = served.state_at(12.5), second = served.state_at(12.5);
        if (first.is_null() || second.is_null()) return "no state";
        if (!(second["state"]["cycle"] > first["state"]["cycle"])) return "the values do not advance";
        if (first["age_ms"] > 400) return "old when they came";

        runtime.reset();
        if (served.page.next("stale", 20s).is_null()) return "a machine that is gone was not said to be stale";
        runtime = std::make_unique<Runtime>(config_at(folder), 99);
        if (served.state_at(99).is_null()) return "the new run is not followed";
        // Where the socket stood in for a moment, LCM takes over again.
        const auto values = served.state_at(99);
        return values.is_null() ? "the new run's values stop" : "";
    });
}

TEST(LcmValues, AreAskedForOverTheSocketWhereMulticastHasNoRoute) {
    RUN_IN_OWN_NETWORK([]() -> std::string {
        const Folder folder;
        const Runtime runtime{config_at(folder), 3};
        Served served{folder, ValueSource::automatic};
        if (!runtime.runs() || !served.open()) return "does not run";
        const auto hello = served.told("socket");
        if (hello.is_null()) return "the page was never told that its values come over the socket";
        const auto why = hello["why_not_lcm"].get<std::string>();
        for (const auto* words : {"ip link set lo multicast on", "ip route add 224.0.0.0/4 dev lo"})
            if (why.find(words) == std::string::npos) return "the reason does not name the remedy: " + why;
        const auto first = served.state_at(3), second = served.state_at(3);
        if (first.is_null() || second.is_null()) return "no state";
        return second["state"]["cycle"] > first["state"]["cycle"] ? "" : "the values do not advance";
    });
}

// It says that it publishes, and nothing of it comes: another's messages, another's run, bytes of nobody.
TEST(LcmValues, OfNobodyAreNotShown) {
    RUN_IN_OWN_NETWORK([]() -> std::string {
        if (!test::multicast_on()) return "skip";
        const Folder folder;
        auto config = config_at(folder);
        config.lcm_url = "udpm://239.255.76.67:7668?ttl=0";
        const Runtime runtime{config, 4};
        auto bus = LcmBus::open(*parse_lcm_url(config.lcm_url));
        if (!bus) return bus.error().text();
        std::atomic<bool> ends{false};
        std::thread stranger([&] {
            for (int i = 0; !ends; ++i) {
                std::vector<std::byte> bytes(static_cast<std::size_t>(i % 3000), std::byte{0x7f});
                static_cast<void>((*bus)->publish("TAKTWERK_DEMO_WHOLE_STATE", bytes));
                ::poll(nullptr, 0, 1);
            }
        });
        const auto problem = [&]() -> std::string {
            Served served{folder, ValueSource::automatic};
            if (!runtime.runs() || !served.open()) return "does not run";
            if (served.told("lcm").is_null()) return "a stranger's bytes keep the machine's values away";
            return served.state_at(4).is_null() ? "no state" : "";
        }();
        ends = true;
        stranger.join();
        return problem;
    });
}

TEST(LcmValues, AreLeftToTheSocketWhereOneAsksForIt) {
    RUN_IN_OWN_NETWORK([]() -> std::string {
        if (!test::multicast_on()) return "skip";
        const Folder folder;
        const Runtime runtime{config_at(folder), 5};
        Served served{folder, ValueSource::socket};
        if (!runtime.runs() || !served.open()) return "does not run";
        const auto hello = served.told("socket");
        if (hello.is_null() || hello["why_not_lcm"].get<std::string>().find("--source socket") == std::string::npos)
            return "the reason is another";
        return served.state_at(5).is_null() ? "no state" : "";
    });
}

nlohmann::ordered_json hello_with(nlohmann::ordered_json lcm) { return {{"machine", "demo"}, {"lcm", std::move(lcm)}}; }

TEST(LcmOffers, AreTakenOrRefusedWithTheReason) {
    const nlohmann::ordered_json good{{"url", "udpm://239.255.76.67:7667?ttl=0"}, {"why", ""}, {"rate_hz", 50.0}, {"run", 17}};
    const auto offer = read_lcm_offer(hello_with(good));
    EXPECT_EQ(offer.why_not, "");
    EXPECT_EQ(offer.run, 17);
    EXPECT_EQ(offer.url.text, "udpm://239.255.76.67:7667?ttl=0");
    const auto why = [&](const char* key, nlohmann::ordered_json value) {
        auto lcm = good;
        lcm[key] = std::move(value);
        return read_lcm_offer(hello_with(lcm)).why_not;
    };
    EXPECT_THAT(why("why", "there is no route"), HasSubstr("there is no route"));
    EXPECT_THAT(why("url", "udpm://239.255.76.67:7667?ttl=1"), HasSubstr("ttl=1"));
    EXPECT_THAT(why("url", "memq://"), HasSubstr("memq"));
    EXPECT_THAT(why("url", "tcpq://other"), HasSubstr("udpm"));
    EXPECT_THAT(why("url", 7), HasSubstr("URL"));
    EXPECT_THAT(why("rate_hz", 10), HasSubstr("hmi: {rate: ...}"));
    EXPECT_THAT(why("rate_hz", "fast"), HasSubstr("hmi: {rate: ...}"));
    EXPECT_THAT(why("run", 0), HasSubstr("run"));
    EXPECT_THAT(why("run", 1.5), HasSubstr("run"));
    for (const auto& hello :
         {nlohmann::ordered_json{{"machine", "demo"}}, hello_with(3), nlohmann::ordered_json::array(), nlohmann::ordered_json{}})
        EXPECT_THAT(read_lcm_offer(hello).why_not, HasSubstr("version"));
}

}  // namespace
}  // namespace taktwerk::hmi::web
