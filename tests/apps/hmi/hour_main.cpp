// hmi_hour [SECONDS [CLIENTS]]: the demo in real time with its program, its page served by `taktwerk hmi`, and so many pages open. Samples memory of both
// processes, lateness and alarms; one page presses what an operator presses. A line for each sample, a verdict at the end: exit code 1, something was wrong.
// `./dev soak hour` runs it for one in a network of its own.

#include <atomic>
#include <fstream>
#include <map>
#include <thread>

#include <fmt/format.h>

#include "apps/terminal/exit_code.hpp"
#include "hmi_bridge/socket/client.hpp"
#include "tests/apps/child.hpp"
#include "tests/apps/hmi/quiet_machine.hpp"
#include "tests/apps/machine_files.hpp"
#include "tests/hmi_bridge/web/page_client.hpp"

namespace taktwerk::apps {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;
using hmi::web::PageClient;
using hmi::web::PageJson;

constexpr long most_growth_kb =
    4096;  ///< of a process, from the first fifth of the time on; without the run in memory, which has a bound of its own
constexpr std::chrono::seconds piece_takes{10};  ///< at most
/// What a host without real time says of itself, and what a person at the page does.
constexpr std::array<std::string_view, 3> expected_alarms{"late_wakeups", "base_task_overrun", "dc_not_locked"};

/// The demo as it is, with a socket of its own.
class Demo {
public:
    Demo() {
        auto pattern = (fs::temp_directory_path() / "taktwerk-hour-XXXXXX").string();
        folder = ::mkdtemp(pattern.data());
        fs::create_directories(folder / "machines");
        for (const char* shelf : {"drives", "devices"}) fs::create_directory_symlink(source / "config" / shelf, folder / shelf);
        for (const auto& image : fs::directory_iterator(source / "config/machines"))
            if (image.path().extension() == ".svg") fs::copy_file(image.path(), folder / "machines" / image.path().filename());
        std::ifstream in(demo);
        std::string text{std::istreambuf_iterator<char>(in), {}};
        replace(text, "\nhmi:\n", "\nhmi:\n  socket: " + socket() + "\n");
        std::ofstream(file()) << text;
    }
    ~Demo() {
        std::error_code ignored;
        fs::remove_all(folder, ignored);
    }
    Demo(const Demo&) = delete;
    Demo& operator=(const Demo&) = delete;
    [[nodiscard]] std::string socket() const { return folder / "demo.sock"; }
    [[nodiscard]] std::string file() const { return folder / "machines/demo.yaml"; }
    fs::path folder;

private:
    static void replace(std::string& text, const std::string& what, const std::string& by) {
        if (const auto at = text.find(what); at != std::string::npos) text.replace(at, what.size(), by);
    }
};

long resident_kb(pid_t process) {
    std::ifstream status("/proc/" + std::to_string(process) + "/status");
    for (std::string word; status >> word;)
        if (word == "VmRSS:") {
            long kb = 0;
            status >> kb;
            return kb;
        }
    return 0;
}

struct Watcher {
    std::atomic<long> states{0};
    std::atomic<bool> lost{false};
};

/// A page that is open: it looks at what comes.
void watch(std::uint16_t port, Watcher& watcher, const std::atomic<bool>& ends) {
    PageClient page;
    if (!page.open(port)) {
        watcher.lost = true;
        return;
    }
    while (!ends) {
        if (page.next("state", 5s).is_null()) {
            watcher.lost = !ends;
            return;
        }
        ++watcher.states;
    }
}

struct Sample {
    long run_kb = 0, hmi_kb = 0;
    long recorded_kb = 0;  ///< of run_kb: the run, for a replay
    [[nodiscard]] long own_kb() const { return run_kb - recorded_kb; }
    double lateness_ms = 0;
    std::int64_t cycle = 0, pieces = 0;
    std::map<std::string, int> unexpected;
};

class Hour {
public:
    Hour(std::chrono::seconds time, int clients) : time_(time), watchers_(static_cast<std::size_t>(clients)) {}

    int go() {
        run_.emplace(std::vector<std::string>{taktwerk, "run", demo_.file(), "--simulate", "--no-events"});
        if (!run_->says("running", 60s)) return fail("the machine does not come up: " + run_->text());
        serve_.emplace(std::vector<std::string>{taktwerk, "hmi", "-s", demo_.socket(), "--listen", "127.0.0.1:0", "--source", "socket",
                                                "--page", std::string(TAKTWERK_BINARY_DIR) + "/hmi_page/page", "--audit",
                                                demo_.folder / "audit.jsonl"});
        if (!serve_->says("http://127.0.0.1:", 20s)) return fail("the page is not served: " + serve_->text());
        const auto at = serve_->text().find("http://127.0.0.1:") + 17;
        port_ = static_cast<std::uint16_t>(std::stoi(serve_->text().substr(at, 6)));
        for (auto& watcher : watchers_) threads_.emplace_back([this, &watcher] { watch(port_, watcher, ends_); });
        press_start();
        sample_all();
        ends_ = true;
        for (auto& thread : threads_) thread.join();
        end_both();
        return judge();
    }

private:
    int fail(const std::string& why) {
        fmt::print("WRONG: {}\n", why);
        return 1;
    }
    void wrong(std::string why) {
        fmt::print("WRONG: {}\n", why);
        wrong_.push_back(std::move(why));
    }
    void press_start() const {
        for (const char* value : {"1", "0"}) {
            Child press({taktwerk, "simulate", "-s", demo_.socket(), "input", "start_button", value});
            if (press.wait(10s) != exit_ok) fmt::print("the start button: {}\n", press.text());
            std::this_thread::sleep_for(200ms);
        }
    }
    Sample look() {
        Sample sample;
        sample.run_kb = resident_kb(run_->pid());
        sample.hmi_kb = resident_kb(serve_->pid());
        auto client = hmi::Client::connect(demo_.socket());
        if (!client) return sample;
        if (const auto kept = client->request({{"cmd", "replay_state"}}, 10s))
            sample.recorded_kb = static_cast<long>((*kept)["replay"].value("memory", 0.0) / 1024);
        const auto answer = client->request({{"cmd", "state"}}, 10s);
        if (!answer) return sample;
        const auto& state = (*answer)["state"];
        sample.cycle = state["cycle"].get<std::int64_t>();
        sample.lateness_ms = state["statistics"].value("lateness_max_ns", 0.0) * 1e-6;
        for (const auto& alarm : state["alarms"]) {
            const auto name = alarm.value("name", std::string("?"));
            if (std::find(expected_alarms.begin(), expected_alarms.end(), name) == expected_alarms.end()) ++sample.unexpected[name];
        }
        for (const auto& variable : state["variables"])
            if (variable.value("name", std::string()) == "pieces") sample.pieces = variable.value("value", std::int64_t{0});
        return sample;
    }
    void sample_all() {
        const auto begin = std::chrono::steady_clock::now();
        const auto every = std::max<std::chrono::milliseconds>(time_ / 60, 2s);
        fmt::print("{:>7} {:>12} {:>10} {:>11} {:>10} {:>12} {:>10} {:>8}\n", "s", "cycle", "run kB", "of record", "hmi kB", "late ms",
                   "states", "pieces");
        for (auto next = begin + every; next <= begin + time_; next += every) {
            std::this_thread::sleep_until(next);
            const auto sample = look();
            samples_.push_back(sample);
            long states = 0;
            for (const auto& watcher : watchers_) states += watcher.states;
            fmt::print("{:>7} {:>12} {:>10} {:>11} {:>10} {:>12.3f} {:>10} {:>8}\n", (next - begin) / 1s, sample.cycle, sample.run_kb,
                       sample.recorded_kb, sample.hmi_kb, sample.lateness_ms, states, sample.pieces);
            std::fflush(stdout);
            for (const auto& [name, count] : sample.unexpected) wrong(fmt::format("alarm {} after {} s", name, (next - begin) / 1s));
            if (samples_.size() < 2) continue;
            const auto& before = samples_[samples_.size() - 2];
            if (sample.cycle <= before.cycle) wrong("the cycle stands still");
            if (every >= piece_takes && sample.pieces <= before.pieces) wrong("no piece was made");
        }
    }
    void end_both() {
        serve_->signal(SIGTERM);
        if (const int code = serve_->wait(10s); code != exit_ok) wrong(fmt::format("taktwerk hmi ended with {}: {}", code, serve_->text()));
        run_->signal(SIGTERM);
        if (const int code = run_->wait(20s); code != exit_ok) wrong(fmt::format("taktwerk run ended with {}: {}", code, run_->text()));
    }
    int judge() {
        if (samples_.empty()) return fail("too short for a sample");
        const auto& settled = samples_[samples_.size() / 5];
        const auto& last = samples_.back();
        for (const auto& [what, before, after] :
             {std::tuple{"taktwerk run", settled.own_kb(), last.own_kb()}, std::tuple{"taktwerk hmi", settled.hmi_kb, last.hmi_kb}})
            if (after > before + most_growth_kb) wrong(fmt::format("{} has grown from {} to {} kB", what, before, after));
        for (const auto& watcher : watchers_) {
            if (watcher.lost) wrong("a page was lost");
            if (watcher.states < 2 * (time_ / 1s)) wrong(fmt::format("a page saw {} states only", watcher.states.load()));
        }
        fmt::print("{}\n", wrong_.empty() ? "well: no alarm, memory flat, pieces made, each page up to date" : "not well");
        return wrong_.empty() ? 0 : 1;
    }

    std::chrono::seconds time_;
    Demo demo_;
    std::optional<Child> run_, serve_;
    std::uint16_t port_ = 0;
    std::vector<Watcher> watchers_;
    std::vector<std::thread> threads_;
    std::atomic<bool> ends_{false};
    std::vector<Sample> samples_;
    std::vector<std::string> wrong_;
};

}  // namespace
}  // namespace taktwerk::apps

int main(int count, char** words) {
    const auto seconds = count > 1 ? std::atol(words[1]) : 3600;
    const auto clients = count > 2 ? std::atoi(words[2]) : 8;
    return taktwerk::apps::Hour{std::chrono::seconds{seconds}, clients}.go();
}
