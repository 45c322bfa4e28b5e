// The built command on its own threads, and everything around it that may stand in the way of its end: a terminal or a pipe that takes
// nothing, a disk that is full or hangs, signals, programs that crash (docs/stopping.md; those that never return:
// alone/hung_program_machine.cpp). All waits are bounded, and wide: that an end comes at all is what counts here; the cycles are counted
// in tests/hmi_bridge/stopping_machine.cpp.

#include <sys/stat.h>

#include <csignal>
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "apps/terminal/exit_code.hpp"
#include "apps/terminal/line_writer.hpp"
#include "tests/apps/child.hpp"
#include "tests/apps/machine_files.hpp"
#include "tests/apps/stopping.hpp"

namespace taktwerk::apps {
namespace {

using namespace std::chrono_literals;
using ::testing::AnyOf;
using ::testing::HasSubstr;

/// A named pipe that is full and stays so: whoever writes to it waits.
class FullPipe {
public:
    explicit FullPipe(std::string path) : path_(std::move(path)) {
        EXPECT_EQ(::mkfifo(path_.c_str(), 0600), 0);
        end_ = ::open(path_.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
        const std::string filler(4096, '.');
        while (::write(end_, filler.data(), filler.size()) > 0) {}
        while (::write(end_, filler.data(), 1) > 0) {}
    }
    ~FullPipe() { ::close(end_); }
    FullPipe(const FullPipe&) = delete;
    FullPipe& operator=(const FullPipe&) = delete;
    /// From now on there is room; what has come.
    std::string drain(std::chrono::milliseconds patience) const {
        std::string all;
        const auto until = std::chrono::steady_clock::now() + patience;
        while (std::chrono::steady_clock::now() < until) {
            char part[4096];
            const auto got = ::read(end_, part, sizeof part);
            if (got > 0) all.append(part, static_cast<std::size_t>(got));
            else ::poll(nullptr, 0, 10);
        }
        return all;
    }
    [[nodiscard]] const std::string& path() const { return path_; }

private:
    std::string path_;
    int end_ = -1;
};

// --- where lines and files go ------------------------------------------------------------------------------------------------------------

TEST_F(Stopping, APipeThatTakesNothingHoldsUpNeitherAStopNorTheEnd) {
    const FullPipe pipe{(folder / "out").string()};
    Child run({"sh", "-c", "exec " + taktwerk + " run " + machine() + " >" + pipe.path()});
    ASSERT_TRUE(runs()) << run.text();
    ASSERT_TRUE(moves()) << refused.text();
    EXPECT_TRUE(ask({{"cmd", "stop"}})) << refused.text();
    EXPECT_TRUE(until([&] { return velocity() == 0; }));
    run.signal(SIGTERM);
    EXPECT_EQ(run.wait(20s), exit_ok) << run.text();
}

TEST_F(Stopping, StandardOutputThatIsClosedEndsNothing) {
    Child run({"sh", "-c", "exec " + taktwerk + " run " + machine() + " >&-"});
    ASSERT_TRUE(runs()) << run.text();
    ASSERT_TRUE(moves()) << refused.text();
    run.signal(SIGTERM);
    EXPECT_EQ(run.wait(20s), exit_ok) << run.text();
}

TEST_F(Stopping, ATraceOnAFullDiskIsSaidAtOnceAndTheMachineRunsOn) {
    Child run({taktwerk, "run", machine(), "--trace", "/dev/full"});
    ASSERT_TRUE(runs()) << run.text();
    EXPECT_TRUE(run.says("the trace is not complete", 60s)) << run.text();
    EXPECT_TRUE(runs());
    run.signal(SIGTERM);
    EXPECT_EQ(run.wait(20s), exit_bad_file) << run.text();
}

TEST_F(Stopping, ATraceOnADiskThatHangsDoesNotHoldUpTheEnd) {
    const FullPipe disk{(folder / "trace").string()};
    Child run({taktwerk, "run", machine(), "--trace", disk.path()});
    ASSERT_TRUE(runs()) << run.text();
    ASSERT_TRUE(moves()) << refused.text();
    run.signal(SIGTERM);
    EXPECT_EQ(run.wait(30s), exit_bad_file) << run.text();
    EXPECT_THAT(run.text(), HasSubstr("a disk does not take the rest of the trace"));
}

TEST(LineWriter, WhatDoesNotFitIsDroppedCountedAndSaid) {
    const std::filesystem::path folder = std::filesystem::temp_directory_path() / ("taktwerk-lines-" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder);
    {
        const FullPipe pipe{(folder / "out").string()};
        const int end = ::open(pipe.path().c_str(), O_WRONLY | O_CLOEXEC);
        LineWriter writer{end, [](std::uint64_t count) { return std::to_string(count) + " lines are missing\n"; }};
        const std::string line(1023, 'x');
        for (int i = 0; i < 2000; ++i) writer.put(line + "\n");  // twice what may wait
        EXPECT_GE(writer.dropped(), 900u);
        const auto dropped = writer.dropped();
        const auto heard = pipe.drain(3s);
        EXPECT_THAT(heard, HasSubstr("\n" + std::to_string(dropped) + " lines are missing\n"));
        writer.put("the last one\n");
        writer.finish(5s);
        EXPECT_THAT(pipe.drain(200ms), HasSubstr("the last one\n"));
        ::close(end);
    }
    std::filesystem::remove_all(folder);
}

// --- signals -----------------------------------------------------------------------------------------------------------------------------

class StoppingBySignal : public Stopping, public ::testing::WithParamInterface<int> {};

TEST_P(StoppingBySignal, EndsWithARampHoweverOftenItComes) {
    Child run({taktwerk, "run", machine()});
    ASSERT_TRUE(runs()) << run.text();
    ASSERT_TRUE(moves()) << refused.text();
    run.signal(GetParam());
    EXPECT_TRUE(run.says("axes stop along their ramps", 20s)) << run.text();
    run.signal(GetParam());
    EXPECT_EQ(run.wait(20s), exit_ok) << run.text();
    EXPECT_THAT(run.text(), HasSubstr("-> Disabled")) << "it ramped down and lost its power in order";
}

INSTANTIATE_TEST_SUITE_P(Of, StoppingBySignal, ::testing::Values(SIGINT, SIGTERM, SIGHUP, SIGQUIT),
                         [](const auto& signal) { return "signal_" + std::to_string(signal.param); });

TEST_F(Stopping, SignalsThatMeanNothingToAMachineChangeNothing) {
    Child run({taktwerk, "run", machine()});
    ASSERT_TRUE(runs()) << run.text();
    for (const int signal : {SIGUSR1, SIGUSR2, SIGALRM, SIGTSTP, SIGTTIN, SIGTTOU, SIGPIPE, SIGXFSZ}) run.signal(signal);
    EXPECT_TRUE(moves()) << refused.text();
    run.signal(SIGTERM);
    EXPECT_EQ(run.wait(20s), exit_ok) << run.text();
}

TEST_F(Stopping, ARunThatEndsBeforeItIsUpSaysWhatEndedItAndHasNotEndedWell) {
    Child timed({taktwerk, "run", machine(), "--duration", "5ms"});  // the bring-up listens longer than that before it sends anything
    EXPECT_EQ(timed.wait(60s), exit_bus) << timed.text();
    EXPECT_THAT(timed.text(), HasSubstr("ended by --duration: the bus was not operational yet")) << timed.text();
}

TEST_F(Stopping, PositionsOnADiskThatTakesNothingHoldUpNeitherTheAxesNorTheBusAndEndIn9) {
    const auto kept = folder / "kept";
    std::filesystem::create_directories(kept);
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    GTEST_SKIP() << "a sanitizer wants to be the first library of a process";
#endif
    // The first writing, at the start, goes well; the next one never comes back.
    Child run({"env", "LD_PRELOAD=" + std::string(TAKTWERK_BINARY_DIR) + "/tests/hanging_disk.so", "TAKTWERK_TEST_HANGS=/retain.1.new",
               taktwerk, "run", absolute(), "--retain", kept.string()});
    ASSERT_TRUE(runs()) << run.text();
    ASSERT_TRUE(until([&] { return std::filesystem::exists(kept / "retain.0"); })) << run.text();
    ASSERT_TRUE(moves()) << refused.text();
    EXPECT_TRUE(ask({{"cmd", "stop"}})) << refused.text();
    EXPECT_TRUE(until([&] { return velocity() == 0; }));
    EXPECT_FALSE(std::filesystem::exists(kept / "retain.1")) << "the disk was not to take it";
    EXPECT_TRUE(run.says("What is kept cannot be written", 60s)) << "a person is told: " << run.text();
    run.signal(SIGTERM);
    EXPECT_TRUE(run.says("-> Disabled", 30s)) << "the axis lost its power in order: " << run.text();
    EXPECT_EQ(run.wait(30s), exit_hung) << run.text();
    EXPECT_THAT(run.text(), HasSubstr("a disk does not take what is kept"));
    EXPECT_THAT(run.text(), ::testing::Not(HasSubstr("Mend that program"))) << "no program is to blame";
}

// --- what crashes ------------------------------------------------------------------------------------------------------------------------

struct Crash {
    const char* name;
    int how, signal;
};
class StoppingByCrash : public Stopping, public ::testing::WithParamInterface<Crash> {};

TEST_P(StoppingByCrash, LeavesALineThatNamesProgramTaskAndSignal) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    GTEST_SKIP() << "the sanitizer speaks instead";
#endif
    Child run({taktwerk, "run", dying(GetParam().how)});
    EXPECT_EQ(run.wait(60s), 128 + GetParam().signal) << run.text();
    EXPECT_THAT(run.text(), HasSubstr("taktwerk crashed in 'main' of program 'dying': " + std::string(GetParam().name)));
}

INSTANTIATE_TEST_SUITE_P(By, StoppingByCrash,
                         ::testing::Values(Crash{"SIGSEGV", 1, SIGSEGV}, Crash{"SIGFPE", 3, SIGFPE}, Crash{"SIGABRT", 5, SIGABRT}),
                         [](const auto& crash) { return crash.param.name; });

TEST_F(Stopping, ARecursionWithoutEndLeavesItsLineAlthoughTheStackIsUsedUp) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    GTEST_SKIP() << "the sanitizer speaks instead";
#endif
    Child run({taktwerk, "run", dying(4)});
    EXPECT_EQ(run.wait(60s), 128 + SIGSEGV) << run.text();
    EXPECT_THAT(run.text(), HasSubstr("taktwerk crashed in 'main' of program 'dying': SIGSEGV"));
}

}  // namespace
}  // namespace taktwerk::apps
