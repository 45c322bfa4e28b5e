// What the service manager and the journal hear of a machine. Sources: sd_notify(3), sd_watchdog_enabled(3), systemd.exec(5) $JOURNAL_STREAM, and the
// journal's native protocol (systemd.io/JOURNAL_NATIVE_PROTOCOL).

#include <sys/stat.h>

#include <sys/wait.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <map>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "apps/machine/journal.hpp"
#include "apps/machine/systemd_link.hpp"
#include "apps/machine/unfinished_run.hpp"
#include "tests/apps/datagram_in.hpp"

namespace taktwerk::apps {
namespace {

using namespace std::chrono_literals;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

struct Service : ::testing::Test {
    Service() {
        auto pattern = (std::filesystem::temp_directory_path() / "taktwerk-service-XXXXXX").string();
        folder = ::mkdtemp(pattern.data());
        heard.emplace((folder / "notify").string());
        environment["NOTIFY_SOCKET"] = heard->path();
    }
    ~Service() override {
        heard.reset();
        std::error_code ignored;
        std::filesystem::remove_all(folder, ignored);
    }
    SystemdLink manager() {
        return SystemdLink{[this](const char* name) -> const char* {
            const auto found = environment.find(name);
            return found == environment.end() ? nullptr : found->second.c_str();
        }};
    }
    static Instant at(Duration since) { return Instant{} + since; }

    std::filesystem::path folder;
    std::optional<DatagramIn> heard;
    std::map<std::string, std::string> environment;
};

TEST_F(Service, IsReadyOnceAndStopsOnce) {
    auto m = manager();
    ASSERT_TRUE(m.present());
    m.ready(), m.ready();
    m.stopping(), m.stopping();
    EXPECT_THAT(heard->all(), ElementsAre("READY=1", "STOPPING=1"));
}

TEST_F(Service, WithoutAManagerNothingIsSent) {
    environment.clear();
    auto m = manager();
    EXPECT_FALSE(m.present());
    m.ready(), m.status("x"), m.alive(at(1s), 1), m.stopping();
    EXPECT_TRUE(heard->all().empty());
}

TEST_F(Service, AnAbstractAddressIsOne) {
    const DatagramOut nobody{"@taktwerk-nobody-listens-here"};
    EXPECT_TRUE(nobody.open());
    EXPECT_FALSE(nobody.send("READY=1"));
    EXPECT_FALSE(DatagramOut{"relative"}.open());
    EXPECT_FALSE(DatagramOut{""}.open());
    EXPECT_FALSE(DatagramOut{"/" + std::string(200, 'x')}.open());
}

TEST_F(Service, AStatusIsSaidWhenItIsAnotherAndIsOneLine) {
    auto m = manager();
    m.status("running"), m.status("running"), m.status("two\nlines");
    EXPECT_THAT(heard->all(), ElementsAre("STATUS=running", "STATUS=two lines"));
}

// sd_notify(3): EXTEND_TIMEOUT_USEC has to come again within its own time.
TEST_F(Service, ABringUpAsksForMoreTimeEachSecond) {
    auto m = manager();
    for (int ms = 0; ms <= 3500; ++ms) m.starting(at(std::chrono::milliseconds{ms}), "x_drive: PREOP");
    EXPECT_EQ(heard->count("EXTEND_TIMEOUT_USEC=30000000"), 4u);
    EXPECT_EQ(heard->count("STATUS=x_drive: PREOP"), 1u);
    m.ready();
    m.starting(at(9s), "late");
    EXPECT_EQ(heard->count("EXTEND_TIMEOUT_USEC=30000000"), 4u);
    EXPECT_EQ(heard->count("STATUS=late"), 0u);
}

// sd_watchdog_enabled(3) recommends half of the time; a quarter leaves room for one that is lost.
TEST_F(Service, TheWatchdogIsFedByCyclesThatAdvanceAndByNothingElse) {
    environment["WATCHDOG_USEC"] = "2000000";
    auto m = manager();
    ASSERT_EQ(m.watchdog(), Duration{2s});
    std::uint64_t cycles = 0;
    for (int ms = 0; ms < 2000; ++ms) m.alive(at(std::chrono::milliseconds{ms}), ++cycles);
    EXPECT_EQ(heard->count("WATCHDOG=1"), 4u);
    // From here it stands still: those cycles that came behind the last sign of life still give one, and then there is none.
    for (int ms = 2000; ms < 6000; ++ms) m.alive(at(std::chrono::milliseconds{ms}), cycles);
    EXPECT_EQ(heard->count("WATCHDOG=1"), 5u);
    m.alive(at(6s), ++cycles);
    EXPECT_EQ(heard->count("WATCHDOG=1"), 6u) << "it goes on";
}

TEST_F(Service, AWatchdogForAnotherProcessIsNotOurs) {
    environment["WATCHDOG_USEC"] = "2000000";
    environment["WATCHDOG_PID"] = "1";
    EXPECT_EQ(manager().watchdog(), std::nullopt);
    environment["WATCHDOG_PID"] = std::to_string(::getpid());
    EXPECT_EQ(manager().watchdog(), Duration{2s});
    for (const char* wrong : {"", "0", "2s", "-1", "99999999999999999999"}) {
        environment["WATCHDOG_USEC"] = wrong;
        EXPECT_EQ(manager().watchdog(), std::nullopt) << wrong;
    }
}

TEST_F(Service, AManagerThatTakesNothingHoldsNobodyUp) {
    auto m = manager();
    for (int i = 0; i < 10'000; ++i) m.status(std::to_string(i));  // far more than its queue holds
    EXPECT_LT(heard->all().size(), 10'000u);
}

runtime::AlarmText drive_fault() {
    runtime::AlarmText words;
    words.source = "axis x", words.name = "drive_fault", words.english = "The drive reports a fault", words.chinese = "驱动器报告故障";
    words.cause = "first line\nsecond line", words.remedy = "look at its display", words.reaction = "stop axis", words.reset = "reset";
    return words;
}

TEST_F(Service, AnAlarmInTheJournalHasFields) {
    const auto words = drive_fault();
    const auto fields = journal_fields("cell", {18.312, "ALARM", "axis x: The drive reports a fault", {}, &words});
    for (const char* line : {"MESSAGE=ALARM: axis x: The drive reports a fault\n", "PRIORITY=3\n", "TAKTWERK_MACHINE=cell\n",
                             "TAKTWERK_ALARM=drive_fault\n", "TAKTWERK_AXIS=x\n", "TAKTWERK_TIME=18.312\n", "SYSLOG_IDENTIFIER=taktwerk\n",
                             "TAKTWERK_REMEDY=look at its display\n", "TAKTWERK_CHINESE=驱动器报告故障\n"})
        EXPECT_THAT(fields, HasSubstr(line));
    // A value of several lines: name, new line, size as 64 bits little-endian, value, new line.
    EXPECT_THAT(fields, HasSubstr(std::string("TAKTWERK_CAUSE\n\x16\0\0\0\0\0\0\0first line\nsecond line\n", 15 + 8 + 22 + 1)));
}

TEST_F(Service, HowGraveAnEntryIsStandsInItsPriority) {
    auto words = drive_fault();
    const auto of = [&](const char* reaction) {
        words.reaction = reaction;
        return journal_fields("cell", {0, "ALARM", "t", {}, &words});
    };
    EXPECT_THAT(of("warn"), HasSubstr("PRIORITY=4\n"));
    EXPECT_THAT(of("none"), HasSubstr("PRIORITY=6\n"));
    EXPECT_THAT(of("power off"), HasSubstr("PRIORITY=3\n"));
    EXPECT_THAT(journal_fields("cell", {0, "STUCK", "t"}), HasSubstr("PRIORITY=2\n"));
    EXPECT_THAT(journal_fields("cell", {0, "gone", "t"}), HasSubstr("PRIORITY=5\n"));
    EXPECT_THAT(journal_fields("cell", {0, "axis y", "Disabled -> Standstill"}), HasSubstr("TAKTWERK_AXIS=y\n"));
}

// An entry whose text would forge fields is one field.
TEST_F(Service, ATextCannotForgeAField) {
    const auto fields = journal_fields("cell", {0, "program", "x\nPRIORITY=0"});
    EXPECT_THAT(fields, HasSubstr("MESSAGE\n"));
    EXPECT_THAT(fields, Not(HasSubstr("MESSAGE=")));
}

TEST_F(Service, TheJournalIsTheOutputWhereTheManagerSaysSo) {
    struct stat output {};
    ASSERT_EQ(::fstat(STDOUT_FILENO, &output), 0);
    const auto own = std::to_string(output.st_dev) + ":" + std::to_string(output.st_ino);
    EXPECT_TRUE(output_is_journal(own.c_str()));
    EXPECT_FALSE(output_is_journal((own + "1").c_str()));
    EXPECT_FALSE(output_is_journal(nullptr));
}

TEST_F(Service, AnEntryGoesToTheJournalOrIsGivenBack) {
    EXPECT_FALSE((Journal{"cell", (folder / "nobody").string()}.take({0, "mode", "automatic"})));
    EXPECT_TRUE((Journal{"cell", heard->path()}.take({0, "mode", "automatic"})));
    ASSERT_EQ(heard->all().size(), 1u);
    EXPECT_THAT(heard->all()[0], HasSubstr("MESSAGE=mode: automatic\n"));
}

struct Marked : Service {
    std::string mark() const { return (folder / "cell.running").string(); }
};

TEST_F(Marked, AnOrderedEndLeavesNothing) {
    auto run = UnfinishedRun::begin(mark(), "boot");
    EXPECT_FALSE(run.before());
    EXPECT_FALSE(run.trouble());
    EXPECT_TRUE(std::filesystem::exists(mark()));
    run.ended();
    EXPECT_FALSE(std::filesystem::exists(mark()));
}

TEST_F(Marked, ARunThatWasKilledIsSeenByTheNext) {
    const auto child = ::fork();
    if (child == 0) {
        const bool begun = !UnfinishedRun::begin(mark(), "boot").trouble();
        ::_exit(begun ? 0 : 1);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    ASSERT_EQ(status, 0);
    auto next = UnfinishedRun::begin(mark(), "boot");
    ASSERT_TRUE(next.before());
    EXPECT_EQ(next.before()->process, child);
    next.ended();
    EXPECT_FALSE(UnfinishedRun::begin(mark(), "boot").before()) << "it was told once";
}

TEST_F(Marked, SwitchingTheComputerOnIsAnOrdinaryStart) {
    std::ofstream(mark()) << "another-boot 1 0\n";
    EXPECT_FALSE(UnfinishedRun::begin(mark(), "boot").before());
}

// The same number, begun at another time.
TEST_F(Marked, ANumberThatIsAnothersByNowIsARunThatEnded) {
    std::ofstream(mark()) << "boot " << ::getppid() << " 1\n";
    EXPECT_TRUE(UnfinishedRun::begin(mark(), "boot").before());
}

// Cut short by a full /run or altered: nobody knows how that run ended, and a machine that starts in manual mode does no harm.
TEST_F(Marked, BehindAMarkThatNobodyUnderstandsNothingStartsByItself) {
    for (const char* text : {"", "boot", "boot x 1", "boot -3 1", "\xff\xff"}) {
        std::ofstream(mark()) << text;
        auto run = UnfinishedRun::begin(mark(), "boot");
        EXPECT_TRUE(run.before()) << text;
        run.ended();
        EXPECT_FALSE(UnfinishedRun::begin(mark(), "boot").before()) << text;
        std::filesystem::remove(mark());
    }
}

TEST_F(Marked, AMarkThatCannotBeWrittenHidesNoCrash) {
    std::filesystem::create_directories(mark() + "/in the way");
    const auto run = UnfinishedRun::begin(mark(), "boot");
    ASSERT_TRUE(run.trouble());
    EXPECT_EQ(run.trouble()->code, "run.mark");
    EXPECT_TRUE(run.before());
    EXPECT_FALSE(std::filesystem::exists(mark() + ".new"));
}

// A link of somebody else's: what it leads to stays as it is.
TEST_F(Marked, IsNotWrittenThroughALink) {
    std::ofstream(folder / "another's") << "mine";
    std::filesystem::create_symlink("another's", mark());
    (void)UnfinishedRun::begin(mark(), "boot");
    std::ifstream file(folder / "another's");
    std::string text;
    file >> text;
    EXPECT_EQ(text, "mine");
}

TEST_F(Marked, WhereItCannotBeWrittenIsSaid) {
    const auto run = UnfinishedRun::begin((folder / "missing/cell.running").string(), "boot");
    ASSERT_TRUE(run.trouble());
    EXPECT_EQ(run.trouble()->code, "run.mark");
    EXPECT_THAT(run.trouble()->text(), HasSubstr("missing/cell.running"));
    EXPECT_FALSE(run.before());
}

}  // namespace
}  // namespace taktwerk::apps
