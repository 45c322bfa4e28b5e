#pragma once
// The built command on its own threads, for tests of what may stand in the way of its end. All waits are bounded, and wide.

#include <poll.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <optional>
#include <sstream>
#include <string>
#include <utility>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "hmi_bridge/socket/client.hpp"
#include "tests/apps/machine_files.hpp"

namespace taktwerk::apps {

using namespace std::chrono_literals;

/// minimal.yaml in a folder of its own, and the questions that are asked of it.
class Stopping : public ::testing::Test {
protected:
    Stopping() {
        std::filesystem::create_directories(folder / "machines");
        std::filesystem::create_directory_symlink(source / "config/drives", folder / "drives");
    }
    ~Stopping() override {
        std::error_code ignored;
        std::filesystem::remove_all(folder, ignored);
    }
    static std::string new_folder() {
        auto pattern = (std::filesystem::temp_directory_path() / "taktwerk-stopping-XXXXXX").string();
        return ::mkdtemp(pattern.data());
    }
    /// minimal.yaml with a socket of its own and `more`.
    std::string machine(const std::string& more = "") {
        std::ostringstream text;
        text << std::ifstream(source / "config/machines/minimal.yaml").rdbuf();
        auto file = (folder / "machines/stopping.yaml").string();
        std::ofstream(file) << text.str() << "hmi: { socket: '" << socket
                            << "', lcm: { enabled: false } }\nsimulation: { supervision: relaxed }\n"
                            << more;
        return file;
    }
    /// With an absolute encoder.
    std::string absolute() {
        auto file = machine();
        std::ostringstream text;
        text << std::ifstream(file).rdbuf();
        auto changed = text.str();
        const std::string homing = "    homing: { kind: set_here }\n";
        changed.replace(changed.find(homing), homing.size(), homing + "    position_memory: { absolute: true }\n");
        std::ofstream(file) << changed;
        return file;
    }
    /// With the program that dies.
    std::string dying(int how, int every = 1) {
        return machine("start_mode: automatic\nprograms:\n  dying:\n    library: " + std::string(TAKTWERK_BINARY_DIR) +
                       "/tests/dying_program.so\n    autostart: true\n    parameters: { how: " + std::to_string(how) +
                       " }\n    tasks:\n      main: { every: " + std::to_string(every) + " cycles }\n");
    }
    std::optional<nlohmann::ordered_json> ask(nlohmann::json request) {
        auto client = hmi::Client::connect(socket);
        if (!client) return std::nullopt;
        auto answer = client->request(std::move(request), 5s);
        if (!answer) {
            refused = answer.error();
            return std::nullopt;
        }
        return *answer;
    }
    bool until(const std::function<bool()>& condition, std::chrono::milliseconds patience = 30s) {
        const auto end = std::chrono::steady_clock::now() + patience;
        while (!condition()) {
            if (std::chrono::steady_clock::now() > end) return false;
            ::poll(nullptr, 0, 20);
        }
        return true;
    }
    bool runs() {
        return until([&] {
            const auto state = ask({{"cmd", "state"}});
            return state && (*state)["state"]["phase"] == "running";
        });
    }
    /// x moves; false: it never did. A homed axis in manual mode.
    bool moves() {
        const auto powered = [&] {
            const auto state = ask({{"cmd", "state"}});
            return state && (*state)["state"]["axes"][0]["powered"] == true;
        };
        if (!ask({{"cmd", "enable"}, {"axis", "x"}}) || !until(powered)) return false;
        if (!ask({{"cmd", "home"}, {"axis", "x"}})) return false;
        return until([&] {
                   return ask({{"cmd", "move"}, {"axis", "x"}, {"position", 100000}, {"velocity", 20}}).has_value();
               }) &&
               until([&] { return velocity() > 19; });
    }
    double velocity() {
        const auto state = ask({{"cmd", "state"}});
        return state ? (*state)["state"]["axes"][0]["set_velocity"].get<double>() : -1;
    }

    std::filesystem::path folder = new_folder();
    std::string socket = (folder / "socket").string();
    Error refused;
};

}  // namespace taktwerk::apps
