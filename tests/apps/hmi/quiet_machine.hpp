#pragma once
// `taktwerk run --hmi` of the demo without its programs and happenings: an operator alone with three axes. In a folder of its own; any free port.

#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "hmi_bridge/socket/client.hpp"
#include "tests/apps/child.hpp"
#include "tests/apps/machine_files.hpp"

namespace taktwerk::apps {

class QuietMachine {
public:
    explicit QuietMachine(std::vector<std::string> more = {}) {
        auto pattern = (std::filesystem::temp_directory_path() / "taktwerk-hmi-XXXXXX").string();
        folder = ::mkdtemp(pattern.data());
        std::filesystem::create_directories(folder / "machines");
        std::filesystem::create_directory_symlink(source / "config/drives", folder / "drives");
        std::filesystem::create_directory_symlink(source / "config/devices", folder / "devices");
        const auto text = replaced(replaced(replaced(without(demo, {"programs:", "views:"}), "start_mode: automatic", "start_mode: manual"),
                                            "enabled: true, required: false", "enabled: false"),
                                   "\nhmi:\n", "\nhmi:\n  socket: " + socket() + "\n");
        std::ofstream(folder / "machines" / "demo.yaml") << text;
        std::vector<std::string> arguments{taktwerk, "run", (folder / "machines" / "demo.yaml").string(), "--no-events"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        child.emplace(arguments);
    }
    ~QuietMachine() {
        child.reset();
        std::error_code ignored;
        std::filesystem::remove_all(folder, ignored);
    }
    QuietMachine(const QuietMachine&) = delete;
    QuietMachine& operator=(const QuietMachine&) = delete;

    [[nodiscard]] std::string socket() const { return (folder / "demo.sock").string(); }
    /// Of the page, once it has been said; 0: it was not.
    std::uint16_t port() {
        if (!child->says("the page: http://127.0.0.1:", std::chrono::seconds{20})) return 0;
        const auto at = child->text().find("the page: http://127.0.0.1:") + 27;
        return static_cast<std::uint16_t>(std::stoi(child->text().substr(at, 6)));
    }
    /// Its state over its own socket; null: none within `patience`.
    nlohmann::ordered_json state(std::chrono::milliseconds patience) {
        for (const auto until = std::chrono::steady_clock::now() + patience;;) {
            if (auto client = hmi::Client::connect(socket()))
                if (auto answer = client->request({{"cmd", "state"}})) return (*answer)["state"];
            if (std::chrono::steady_clock::now() >= until) return {};
            ::usleep(20'000);
        }
    }
    /// -1: it has none yet.
    std::int64_t cycle(std::chrono::milliseconds patience) {
        const auto known = state(patience);
        return known.is_object() ? known["cycle"].get<std::int64_t>() : -1;
    }
    /// The process that `parent` has started, 0: none.
    static pid_t child_of(pid_t parent) {
        for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
            std::ifstream stat(entry.path() / "stat");
            std::string line;
            std::getline(stat, line);
            const auto end = line.rfind(") ");
            if (end == std::string::npos) continue;
            if (std::atoi(line.c_str() + end + 4) == parent) return std::atoi(entry.path().filename().c_str());
        }
        return 0;
    }

    std::filesystem::path folder;
    std::optional<Child> child;

private:
    /// The file's text less those sections.
    static std::string without(const std::string& file, const std::vector<std::string>& keys) {
        std::ifstream in(file);
        std::string text, line;
        for (bool inside = false; std::getline(in, line);) {
            if (!line.empty() && line.front() != ' ')
                inside = std::any_of(keys.begin(), keys.end(), [&](const std::string& key) { return line.starts_with(key); });
            if (!inside) text += line + "\n";
        }
        return text;
    }
    static std::string replaced(std::string text, const std::string& what, const std::string& by) {
        const auto at = text.find(what);
        return at == std::string::npos ? text : text.replace(at, what.size(), by);
    }
};

inline bool page_is_built() { return std::filesystem::exists(std::string(TAKTWERK_BINARY_DIR) + "/hmi_page/page/index.html"); }

}  // namespace taktwerk::apps
