// mbpoll, a Modbus program that is not ours, reads and writes the simulated XP200 over its pseudo-terminal.

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "axes/sim/xp200/station.hpp"
#include "core/clock.hpp"
#include "modbus/line/pseudo_terminal.hpp"
#include "tests/axes/drives/xp200/plain_profile.hpp"

extern char** environ;  // NOLINT(readability-redundant-declaration): POSIX leaves it to the program

namespace taktwerk::axes::sim::xp200 {
namespace {

using namespace std::chrono_literals;

struct Ran {
    int status = -1;
    std::string output;
};

/// A drive in speed control at station 1, on a pseudo-terminal; `mbpoll` runs while it is served.
class Served {
public:
    Served() : profile_(axes::xp200::plain_profile()), drive_(*profile_, PlantConfig{}, {.start_up = 0ms}) {
        for (const auto& [number, value] : {std::pair{181, 1}, {4, 1}, {25, 1}})
            drive_.servo().parameters().commission(static_cast<std::uint16_t>(number), value);
        auto opened = modbus::PseudoTerminal::open(modbus::LineSettings{});
        if (!opened) throw std::runtime_error(opened.error().text());
        terminal_ = std::move(*opened);
        terminal_->connect(drive_);
        drive_.servo().power_on(clock_.now());
    }
    Servo& servo() { return drive_.servo(); }

    Ran mbpoll(std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), {"mbpoll", "-m", "rtu", "-a", "1", "-b", "19200", "-P", "even", "-0", "-1", "-q"});
        const auto port = std::find(arguments.begin(), arguments.end(), "PORT");
        if (port != arguments.end()) *port = terminal_->path();
        std::vector<char*> argv;
        for (auto& a : arguments) argv.push_back(a.data());
        argv.push_back(nullptr);
        int pipe[2];
        if (::pipe2(pipe, O_CLOEXEC) != 0) return {};
        posix_spawn_file_actions_t actions;
        ::posix_spawn_file_actions_init(&actions);
        ::posix_spawn_file_actions_adddup2(&actions, pipe[1], 1);
        ::posix_spawn_file_actions_adddup2(&actions, pipe[1], 2);
        pid_t child = 0;
        const bool started = ::posix_spawnp(&child, "mbpoll", &actions, nullptr, argv.data(), environ) == 0;
        ::posix_spawn_file_actions_destroy(&actions);
        ::close(pipe[1]);
        Ran ran;
        const auto give_up = clock_.now() + 20s;
        while (started && clock_.now() < give_up) {
            pollfd waits[] = {{terminal_->descriptor(), POLLIN, 0}, {pipe[0], POLLIN, 0}};
            ::poll(waits, 2, 10);
            terminal_->step(clock_.now());
            char text[4096];
            if ((waits[1].revents & POLLIN) != 0)
                if (const auto got = ::read(pipe[0], text, sizeof text); got > 0) ran.output.append(text, static_cast<std::size_t>(got));
            if ((waits[1].revents & POLLIN) != 0) continue;  // until all is read
            int status = 0;
            if ((waits[1].revents & POLLHUP) != 0 && ::waitpid(child, &status, 0) == child) {
                ran.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
                break;
            }
        }
        if (started && ran.status < 0) {
            ::kill(child, SIGKILL);
            ::waitpid(child, nullptr, 0);
        }
        ::close(pipe[0]);
        return ran;
    }

private:
    SystemClock clock_;
    std::shared_ptr<const DriveProfile> profile_;
    Drive drive_;
    std::unique_ptr<modbus::PseudoTerminal> terminal_;
};

/// "[60]:  100" in the output.
bool shows(const std::string& output, int reference, int value) {
    const auto at = output.find("[" + std::to_string(reference) + "]:");
    if (at == std::string::npos) return false;
    return std::stoi(output.substr(output.find(':', at) + 1)) == value;
}

/// Somewhere on PATH, as posix_spawnp looks for it.
bool installed(const std::string& program) {
    const char* path = std::getenv("PATH");
    std::stringstream folders(path != nullptr ? path : "");
    for (std::string folder; std::getline(folders, folder, ':');)
        if (::access((folder + '/' + program).c_str(), X_OK) == 0) return true;
    return false;
}

class Mbpoll : public ::testing::Test {
protected:
    void SetUp() override {
        ASSERT_TRUE(installed("mbpoll")) << "mbpoll is not installed: apt-get install mbpoll, or all of packaging/apt-packages.txt";
    }
};

// Functions 03h: Pr060 and Pr061 as delivered, 100 ms (manual 5.1.1).
TEST_F(Mbpoll, ReadsParameters) {
    Served drive;
    const auto ran = drive.mbpoll({"-t", "4", "-r", "60", "-c", "2", "PORT"});
    ASSERT_EQ(ran.status, 0) << ran.output;
    EXPECT_TRUE(shows(ran.output, 60, 100)) << ran.output;
    EXPECT_TRUE(shows(ran.output, 61, 100)) << ran.output;
}

// Function 04h: alarm and, with one raised, its number (9.5, 001Ah).
TEST_F(Mbpoll, ReadsStatus) {
    Served drive;
    const auto quiet = drive.mbpoll({"-t", "3", "-r", "26", "-c", "1", "PORT"});
    ASSERT_EQ(quiet.status, 0) << quiet.output;
    EXPECT_TRUE(shows(quiet.output, 26, 0)) << quiet.output;
    drive.servo().raise(12);
    const auto alarm = drive.mbpoll({"-t", "3", "-r", "26", "-c", "1", "PORT"});
    EXPECT_TRUE(shows(alarm.output, 26, 12)) << alarm.output;
}

// One value by 06h or 10h, as mbpoll likes, two by 10h: they arrive; one out of range is refused by exception 03.
TEST_F(Mbpoll, WritesParameters) {
    Served drive;
    ASSERT_EQ(drive.mbpoll({"-t", "4", "-r", "138", "PORT", "600"}).status, 0);
    EXPECT_EQ(drive.servo().parameters()[138], 600);
    ASSERT_EQ(drive.mbpoll({"-t", "4", "-r", "60", "PORT", "250", "300"}).status, 0);
    EXPECT_EQ(drive.servo().parameters()[60], 250);
    EXPECT_EQ(drive.servo().parameters()[61], 300);
    const auto refused = drive.mbpoll({"-t", "4", "-r", "60", "PORT", "20000"});
    EXPECT_NE(refused.output.find("Illegal data value"), std::string::npos) << refused.output;
    EXPECT_EQ(drive.servo().parameters()[60], 250);
}

// At most eight words (9.6.2): nine are refused.
TEST_F(Mbpoll, NineWordsAreTooMany) {
    Served drive;
    const auto ran = drive.mbpoll({"-t", "4", "-r", "137", "-c", "9", "PORT"});
    EXPECT_NE(ran.output.find("Illegal data value"), std::string::npos) << ran.output;
}

}  // namespace
}  // namespace taktwerk::axes::sim::xp200
