// --apply and --revert in a root of their own: what was there before comes back to the byte, and nothing else is touched.
#include <gmock/gmock.h>

#include "apps/doctor/changes.hpp"
#include "apps/doctor/findings.hpp"
#include "tests/apps/doctor/host_tree.hpp"

namespace taktwerk::apps {
namespace {

using namespace std::chrono_literals;
using test::HostTree;
using test::MemoryPorts;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr const char* record_file = "/var/lib/taktwerk/doctor/applied.json";

std::vector<HostChange> wanted_by(const HostTree& host, const EthernetPorts& ports) {
    std::vector<HostChange> all;
    auto findings = host_findings(host_facts(host.files(), 3), {1ms, 100us, 3});
    auto of_port = port_findings(port_facts(host.files(), ports, "eth1"), {1ms, 100us, 3});
    findings.insert(findings.end(), of_port.begin(), of_port.end());
    for (const auto& f : findings) all.insert(all.end(), f.changes.begin(), f.changes.end());
    return all;
}

struct Delivered : ::testing::Test {
    Delivered() {
        test::delivered(host);
        test::free_port(host);
        host.put("/etc/group", "root:x:0:\ntaktwerk:x:990:\n")
            .put("/var/lib/taktwerk/keep", "")
            .put("/etc/sysctl.d/99-theirs.conf", "vm.swappiness = 10\n");
        ports.settings["eth1"] = {.driver = "igb",
                                  .receive_us = 60,
                                  .send_us = 33,
                                  .adaptive_receive = true,
                                  .energy_efficient = true,
                                  .energy_efficient_now = true};
    }
    Changes changes() { return Changes{host.root(), ports}; }
    /// The kernel's file of a choice shows all of them when it is read; a plain file has what was written.
    void kernel_shows_the_choice() { host.put("/sys/kernel/mm/transparent_hugepage/enabled", "always [madvise] never\n"); }
    HostTree host;
    MemoryPorts ports;
};

TEST_F(Delivered, AppliedIsWhatWasFoundAndRevertedIsWhatWasThere) {
    const auto before = host.everything();
    const auto ports_before = ports.settings["eth1"];

    const auto done = changes().apply(wanted_by(host, ports));
    ASSERT_TRUE(done.ok()) << done.error().text();
    for (const auto& outcome : *done) EXPECT_FALSE(outcome.error.has_value()) << outcome.words << outcome.error->text();

    EXPECT_EQ(host.text("/sys/devices/system/cpu/cpu3/cpufreq/scaling_governor"), "performance\n");
    EXPECT_EQ(host.text("/sys/devices/system/cpu/cpu0/cpufreq/scaling_governor"), "powersave\n");  // not the cycle's
    EXPECT_EQ(host.text("/proc/sys/net/core/rmem_max"), "2097152\n");
    EXPECT_EQ(host.text("/proc/sys/vm/compact_unevictable_allowed"), "0\n");
    EXPECT_EQ(host.text("/etc/sysctl.d/60-taktwerk-receive-buffer.conf"), "net.core.rmem_max = 2097152\n");
    EXPECT_THAT(host.text("/etc/tmpfiles.d/taktwerk-governor.conf"), HasSubstr("cpu3/cpufreq/scaling_governor - - - - performance"));
    EXPECT_EQ(host.text("/etc/security/limits.d/60-taktwerk.conf"), "@taktwerk - rtprio 95\n@taktwerk - memlock unlimited\n");
    EXPECT_THAT(host.text("/etc/udev/rules.d/60-taktwerk-eth1-coalescing.rules"),
                HasSubstr("ethtool -C eth1 adaptive-rx off rx-usecs 0 tx-usecs 0"));
    EXPECT_EQ(ports.settings["eth1"].receive_us, 0u);
    EXPECT_EQ(ports.settings["eth1"].adaptive_receive, false);
    EXPECT_EQ(ports.settings["eth1"].energy_efficient, false);
    EXPECT_EQ(host.text("/etc/sysctl.d/99-theirs.conf"), "vm.swappiness = 10\n");

    const auto back = changes().revert();
    ASSERT_TRUE(back.ok()) << back.error().text();
    for (const auto& outcome : *back) {
        EXPECT_FALSE(outcome.error.has_value()) << outcome.words;
        EXPECT_FALSE(outcome.left) << outcome.words;
    }
    // A plain file keeps the word that was written; the kernel would show the choice as before.
    EXPECT_EQ(host.text("/sys/kernel/mm/transparent_hugepage/enabled"), "always\n");
    host.put("/sys/kernel/mm/transparent_hugepage/enabled", "[always] madvise never\n");
    EXPECT_EQ(host.everything(), before);
    EXPECT_EQ(ports.settings["eth1"].receive_us, ports_before.receive_us);
    EXPECT_EQ(ports.settings["eth1"].send_us, ports_before.send_us);
    EXPECT_EQ(ports.settings["eth1"].adaptive_receive, ports_before.adaptive_receive);
    EXPECT_EQ(ports.settings["eth1"].energy_efficient, ports_before.energy_efficient);
}

TEST_F(Delivered, ASecondApplyDoesNothingAndKeepsTheFirstWayBack) {
    const auto wanted = wanted_by(host, ports);
    ASSERT_TRUE(changes().apply(wanted).ok());
    kernel_shows_the_choice();
    const auto record = host.text(record_file);

    const auto again = changes().apply(wanted);
    ASSERT_TRUE(again.ok());
    EXPECT_THAT(*again, IsEmpty());
    EXPECT_EQ(host.text(record_file), record);
    const auto by_its_findings = changes().apply(wanted_by(host, ports));
    ASSERT_TRUE(by_its_findings.ok());
    EXPECT_THAT(*by_its_findings, IsEmpty());

    ASSERT_TRUE(changes().revert().ok());
    EXPECT_EQ(host.text("/proc/sys/net/core/rmem_max"), "212992\n");
    EXPECT_FALSE(host.has(record_file));
}

TEST_F(Delivered, WhatSomebodyElseHasChangedSinceIsLeftAndSaid) {
    ASSERT_TRUE(changes().apply(wanted_by(host, ports)).ok());
    host.put("/proc/sys/net/core/rmem_max", "4194304\n").put("/etc/sysctl.d/60-taktwerk-compaction.conf", "# mine now\n");
    const auto back = changes().revert();
    ASSERT_TRUE(back.ok());
    EXPECT_EQ(std::count_if(back->begin(), back->end(), [](const auto& o) { return o.left; }), 2);
    EXPECT_EQ(host.text("/proc/sys/net/core/rmem_max"), "4194304\n");
    EXPECT_EQ(host.text("/etc/sysctl.d/60-taktwerk-compaction.conf"), "# mine now\n");
    EXPECT_EQ(host.text("/proc/sys/vm/compact_unevictable_allowed"), "1\n");
    for (const auto& outcome : *back)
        if (outcome.left && outcome.words.starts_with("/proc")) {
            EXPECT_THAT(outcome.words, HasSubstr("before --apply it was 212992"));
        }

    // It is still known when they have given their own up.
    host.put("/proc/sys/net/core/rmem_max", "2097152\n");
    const auto later = changes().revert();
    ASSERT_TRUE(later.ok());
    ASSERT_EQ(later->size(), 2u) << "what was taken back is recorded no more";
    EXPECT_EQ(host.text("/proc/sys/net/core/rmem_max"), "212992\n");
    EXPECT_EQ(host.text("/etc/sysctl.d/60-taktwerk-compaction.conf"), "# mine now\n");
}

// Theirs was the last value that was not ours.
TEST_F(Delivered, WhatSomebodyElseHasSetBetweenTwoAppliesComesBack) {
    const HostChange wanted{HostChange::Kind::knob, "/proc/sys/net/core/rmem_max", "2097152"};
    ASSERT_TRUE(changes().apply({wanted}).ok());
    host.put("/proc/sys/net/core/rmem_max", "300000\n");
    ASSERT_TRUE(changes().apply({wanted}).ok());
    EXPECT_EQ(host.text("/proc/sys/net/core/rmem_max"), "2097152\n");
    ASSERT_TRUE(changes().revert().ok());
    EXPECT_EQ(host.text("/proc/sys/net/core/rmem_max"), "300000\n");
    EXPECT_FALSE(host.has(record_file));
}

TEST_F(Delivered, AFileKeepsItsRights) {
    const std::string path = "/etc/sysctl.d/60-taktwerk-receive-buffer.conf";
    host.put(path, "net.core.rmem_max = 1\n");
    std::filesystem::permissions(host.at(path), std::filesystem::perms{0600});
    const auto rights = [&] { return std::filesystem::status(host.at(path)).permissions(); };
    ASSERT_TRUE(changes().apply({{HostChange::Kind::file, path, "net.core.rmem_max = 2\n"}}).ok());
    EXPECT_EQ(host.text(path), "net.core.rmem_max = 2\n");
    EXPECT_EQ(rights(), std::filesystem::perms{0600});
    ASSERT_TRUE(changes().revert().ok());
    EXPECT_EQ(rights(), std::filesystem::perms{0600});
}

// A folder stands where the file should be. A setting of now alone would be gone with a restart, and the doctor would find nothing wrong until then.
TEST_F(Delivered, WhatCannotBeForTheNextStartIsNotForNowEither) {
    host.put("/etc/sysctl.d/60-x.conf/in_the_way", "").put("/proc/sys/vm/compact_unevictable_allowed", "1\n");
    const HostChange now{HostChange::Kind::knob, "/proc/sys/vm/compact_unevictable_allowed", "0"};
    const auto done = changes().apply_together({now, {HostChange::Kind::file, "/etc/sysctl.d/60-x.conf", "x\n"}});
    ASSERT_TRUE(done.ok());
    ASSERT_EQ(done->size(), 1u);
    EXPECT_TRUE(done->front().error.has_value());
    EXPECT_EQ(host.text("/proc/sys/vm/compact_unevictable_allowed"), "1\n");

    const auto both = changes().apply_together({now, {HostChange::Kind::file, "/etc/sysctl.d/60-y.conf", "y\n"}});
    ASSERT_TRUE(both.ok());
    EXPECT_EQ(both->size(), 2u) << "the control";
    EXPECT_EQ(host.text("/proc/sys/vm/compact_unevictable_allowed"), "0\n");
}

TEST_F(Delivered, WhatIsNotThereAnyMoreIsForgotten) {
    ASSERT_TRUE(changes().apply({{HostChange::Kind::knob, "/proc/sys/net/core/rmem_max", "2097152"}}).ok());
    std::filesystem::remove(host.at("/proc/sys/net/core/rmem_max"));
    const auto back = changes().revert();
    ASSERT_TRUE(back.ok());
    ASSERT_EQ(back->size(), 1u);
    EXPECT_THAT(back->front().words, HasSubstr("is not there any more"));
    EXPECT_FALSE(back->front().left);
    EXPECT_FALSE(host.has(record_file));
}

TEST_F(Delivered, AFileThatWasThereComesBackToTheByte) {
    host.put("/etc/sysctl.d/60-taktwerk-receive-buffer.conf", "net.core.rmem_max = 1\n\n  \n");
    ASSERT_TRUE(changes().apply(wanted_by(host, ports)).ok());
    EXPECT_EQ(host.text("/etc/sysctl.d/60-taktwerk-receive-buffer.conf"), "net.core.rmem_max = 2097152\n");
    ASSERT_TRUE(changes().revert().ok());
    EXPECT_EQ(host.text("/etc/sysctl.d/60-taktwerk-receive-buffer.conf"), "net.core.rmem_max = 1\n\n  \n");
}

TEST_F(Delivered, ADriverThatRefusesIsSaidAndLeavesNothingToTakeBack) {
    ports.refuses = true;
    const auto done = changes().apply({{HostChange::Kind::ethernet, "eth1", "0", EthernetKnob::receive_us}});
    ASSERT_TRUE(done.ok());
    ASSERT_EQ(done->size(), 1u);
    ASSERT_TRUE(done->front().error.has_value());
    EXPECT_EQ(done->front().error->code, "doctor.ethernet");
    EXPECT_FALSE(host.has(record_file));
    EXPECT_EQ(ports.settings["eth1"].receive_us, 60u);
}

// The way back is on the disk before anything changes: where it cannot be written, nothing is.
// ethtool(8): drivers round. What is there then is ours as well, and what was there before is not forgotten.
TEST_F(Delivered, AValueThatADriverRoundsIsSaidAndTakenBack) {
    ports.least_us = 3;
    const auto done = changes().apply(wanted_by(host, ports));
    ASSERT_TRUE(done.ok()) << done.error().text();
    const auto rounded =
        std::find_if(done->begin(), done->end(), [](const auto& one) { return one.error && one.error->code == "doctor.not_taken"; });
    ASSERT_NE(rounded, done->end());
    EXPECT_THAT(rounded->error->text(), HasSubstr("it says 3"));
    EXPECT_EQ(ports.settings["eth1"].receive_us, 3u);
    ports.least_us = 0;
    ASSERT_TRUE(changes().revert().ok());
    EXPECT_EQ(ports.settings["eth1"].receive_us, 60u);
}

// Whoever may run --apply is root, who has every right: they are made for others.
TEST_F(Delivered, RightsAreMadeForOthersAlsoWhereRootHasThem) {
    host.put("/proc/self/status", "CapEff:\t000001ffffffffff\n").put("/dev/cpu_dma_latency", "");
    const auto targets = [&](bool of_others) {
        Wanted wanted{1ms, 100us, 3};
        wanted.of_others = of_others;
        std::string all;
        for (const auto& finding : host_findings(host_facts(host.files(), 3), wanted))
            for (const auto& change : finding.changes) all += change.target + " ";
        return all;
    };
    EXPECT_THAT(targets(true), ::testing::AllOf(HasSubstr("limits.d/60-taktwerk.conf"), HasSubstr("60-taktwerk-latency.rules")));
    EXPECT_THAT(targets(false), ::testing::Not(HasSubstr("limits.d"))) << "the control";
}

TEST_F(Delivered, WithoutARecordNothingIsChanged) {
    host.put("/var/lib/taktwerk/doctor", "a file where the folder should be");
    const auto done = changes().apply(wanted_by(host, ports));
    ASSERT_FALSE(done.ok());
    EXPECT_EQ(done.error().code, "doctor.record");
    EXPECT_EQ(host.text("/proc/sys/net/core/rmem_max"), "212992\n");
    EXPECT_EQ(ports.settings["eth1"].receive_us, 60u);
}

TEST_F(Delivered, ARecordThatIsNoneStopsBoth) {
    for (const auto* text : {"", "{}", "[{}]", "[{\"kind\":\"file\",\"target\":\"\",\"before\":null,\"after\":\"\"}]",
                             "[{\"kind\":\"socket\",\"target\":\"/x\",\"before\":null,\"after\":\"\"}]",
                             "[{\"kind\":\"knob\",\"target\":\"/x\",\"before\":7,\"after\":\"1\"}]",
                             "[{\"kind\":\"ethernet\",\"target\":\"eth1\",\"knob\":\"speed\",\"before\":\"1\",\"after\":\"1\"}]"}) {
        host.put(record_file, text);
        EXPECT_EQ(changes().apply(wanted_by(host, ports)).ok(), false) << text;
        EXPECT_EQ(changes().revert().ok(), false) << text;
        EXPECT_EQ(host.text(record_file), text);
    }
    EXPECT_EQ(host.text("/proc/sys/net/core/rmem_max"), "212992\n");
}

TEST_F(Delivered, TheRecordReadsBackAsItWasWritten) {
    const std::vector<AppliedChange> all{{{HostChange::Kind::file, "/etc/a", "new\n"}, std::nullopt, {"/etc/b"}, "boot-1"},
                                         {{HostChange::Kind::knob, "/proc/x", "1"}, "0", {}, "boot-1"},
                                         {{HostChange::Kind::ethernet, "eth1", "0", EthernetKnob::send_us}, "33", {}, "boot-1"}};
    const auto read = read_record(record_text(all));
    ASSERT_TRUE(read.ok());
    ASSERT_EQ(read->size(), 3u);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ((*read)[i].change.kind, all[i].change.kind);
        EXPECT_EQ((*read)[i].change.target, all[i].change.target);
        EXPECT_EQ((*read)[i].change.value, all[i].change.value);
        EXPECT_EQ((*read)[i].before, all[i].before);
        EXPECT_EQ((*read)[i].made_folders, all[i].made_folders);
        EXPECT_EQ((*read)[i].boot, all[i].boot);
    }
    EXPECT_EQ((*read)[2].change.knob, EthernetKnob::send_us);
}

// Interrupt 124 may be another device's after a restart.
TEST_F(Delivered, AnInterruptsNumberMeansNothingAfterARestart) {
    host.put("/proc/irq/124/smp_affinity_list", "0\n");
    ASSERT_TRUE(changes().apply({{HostChange::Kind::knob, "/proc/irq/124/smp_affinity_list", "3"}}).ok());
    host.put("/proc/sys/kernel/random/boot_id", "boot-2\n");
    ASSERT_TRUE(changes().revert().ok());
    EXPECT_EQ(host.text("/proc/irq/124/smp_affinity_list"), "3\n");
    EXPECT_FALSE(host.has(record_file));
}

}  // namespace
}  // namespace taktwerk::apps
