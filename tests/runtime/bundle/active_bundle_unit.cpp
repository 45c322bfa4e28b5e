// The folder of versions: what is installed, what is active, which one starts, and what is left of what was refused.

#include "runtime/bundle/active_bundle.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "tests/runtime/bundle/small_bundle.hpp"

namespace taktwerk::runtime {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

struct Bundles : ::testing::Test {
    TemporaryFolder folder;
    BundleStore store{folder.path() / "root"};

    std::string file(const std::string& version, const SecretKey* key = nullptr) const {
        return folder.write(version + ".twb", small_bundle(small_manifest(version), key));
    }
    void install(const std::string& version) const {
        const auto installed = store.install(file(version), nobody(), small_host());
        ASSERT_TRUE(installed) << installed.error().text();
    }
    std::string activate(const std::string& version) const {
        const auto switched = runtime::activate(store, "cell", version, nobody(), small_host(), joe);
        return switched ? fmt::format("{} -> {}, back {}", switched->from, switched->to, switched->next_back) : switched.error().code;
    }
    std::string roll_back() const {
        const auto switched = runtime::roll_back(store, "cell", small_host(), joe);
        return switched ? fmt::format("{} -> {}, back {}", switched->from, switched->to, switched->next_back) : switched.error().code;
    }
    /// A start that never reaches operation: its version, and the remarks' codes.
    std::vector<std::string> start(unsigned tries = usual_tries) const {
        auto begun = begin_start(store, "cell", tries, small_host(), {"taktwerk", small_time});
        if (!begun) return {begun.error().code};
        std::vector<std::string> out{begun->bundle.manifest.version};
        for (const auto& remark : begun->remarks) out.push_back(remark.code);
        last = begun->activation;
        return out;
    }
    std::string active() const {
        const auto chain = activations_of(store, "cell");
        return chain.empty() ? "none" : chain.front().version;
    }
    /// Names of everything below the root, but for locks and the like there are none.
    std::vector<std::string> everything() const {
        std::vector<std::string> out;
        std::error_code failed;
        for (fs::recursive_directory_iterator entry(folder.path() / "root", failed), end; !failed && entry != end; entry.increment(failed))
            out.push_back(fs::relative(entry->path(), folder.path() / "root").string());
        std::sort(out.begin(), out.end());
        return out;
    }
    mutable fs::path last;
};

TEST_F(Bundles, AreInstalledBesideEachOtherAndNothingIsActiveByItself) {
    install("1.10");
    install("1.9");
    EXPECT_THAT(store.machines(), ElementsAre("cell"));
    EXPECT_THAT(store.versions("cell"), ElementsAre("1.9", "1.10"));
    EXPECT_EQ(active(), "none");
    const auto found = store.find("cell", "1.9");
    ASSERT_TRUE(found);
    EXPECT_EQ(text_of_file(found->machine_file()), "name: cell # 1.9\n");
    EXPECT_TRUE(verify(*found));
}

TEST_F(Bundles, TheSameAgainIsNoErrorAndAnotherOfThatVersionIs) {
    install("1.0");
    const auto again = store.install(file("1.0"), nobody(), small_host());
    ASSERT_TRUE(again);
    EXPECT_EQ(again->was, BundleStore::Installed::Was::there);
    auto manifest = small_manifest("1.0");
    manifest.created += 1;
    const auto other = store.install(folder.write("other.twb", small_bundle(manifest)), nobody(), small_host());
    ASSERT_FALSE(other);
    EXPECT_EQ(other.error().code, "bundle.other");
    EXPECT_EQ(store.find("cell", "1.0")->manifest.created, small_time);
}

TEST_F(Bundles, OfOneThatIsRefusedNothingIsLeft) {
    const auto key = new_key();
    auto broken = small_bundle(small_manifest("2.0"));
    broken[broken.size() - 1024 - 512 - 1024] ^= 1;  // in the last file that has bytes: found when it is unpacked
    auto host = small_host();
    host.abi = 1;
    const auto refused = [&](const std::string& text, const Trust& trust, const Host& on) {
        const auto installed = store.install(folder.write("x.twb", text), trust, on);
        return installed ? std::string("taken") : installed.error().code;
    };
    EXPECT_EQ(refused(broken, nobody(), small_host()), "bundle.sum");
    EXPECT_THAT(everything(), ElementsAre("bundles")) << "the folder itself";
    EXPECT_EQ(refused(small_bundle(), trust_in(key), small_host()), "bundle.unsigned");
    EXPECT_EQ(refused(small_bundle(), nobody(), host), "bundle.abi");
    EXPECT_EQ(refused("nothing", nobody(), small_host()), "bundle.not_a_bundle");
    EXPECT_THAT(everything(), ElementsAre("bundles"));
    EXPECT_EQ(refused(small_bundle(), nobody(), small_host()), "taken") << "the same place takes one that is good";
}

TEST_F(Bundles, WhatAKilledInstallHasLeftIsSweptUp) {
    fs::create_directories(store.bundles() / ".aside-killed" / "files");
    install("1.0");
    EXPECT_FALSE(fs::exists(store.bundles() / ".aside-killed"));
}

TEST_F(Bundles, ActivationAndTheWayBack) {
    for (const auto* version : {"1.0", "1.1", "1.2"}) install(version);
    EXPECT_EQ(activate("1.0"), " -> 1.0, back ");
    EXPECT_EQ(activate("1.1"), "1.0 -> 1.1, back 1.0");
    EXPECT_EQ(activate("1.2"), "1.1 -> 1.2, back 1.1");
    EXPECT_EQ(roll_back(), "1.2 -> 1.1, back 1.0");
    EXPECT_EQ(roll_back(), "1.1 -> 1.0, back ");
    EXPECT_EQ(roll_back(), "bundle.no_way_back");
    EXPECT_EQ(active(), "1.0");
    EXPECT_EQ(text_of_file(store.folder("cell") / "current/bundle/files/machine/cell.yaml"), "name: cell # 1.0\n");
    EXPECT_EQ(activate("1.2"), "1.0 -> 1.2, back 1.0");
    EXPECT_EQ(activate("1.2"), "1.2 -> 1.2, back 1.0") << "again: the way back stays";
    EXPECT_EQ(roll_back(), "1.2 -> 1.0, back ");
}

TEST_F(Bundles, WhoDidWhatIsWrittenDown) {
    install("1.0"), install("1.1");
    activate("1.0"), activate("1.1"), roll_back();
    std::istringstream lines(text_of_file(store.folder("cell") / "audit.log"));
    std::vector<std::string> said;
    for (std::string line; std::getline(lines, line);) {
        const auto json = nlohmann::json::parse(line);
        EXPECT_EQ(json["who"], "joe (1000)");
        EXPECT_EQ(json["time"], "2026-11-26T05:12:00Z");
        said.push_back(
            fmt::format("{} {} {}", json["did"].get<std::string>(), json["from"].get<std::string>(), json["to"].get<std::string>()));
    }
    EXPECT_THAT(said, ElementsAre("activate  1.0", "activate 1.0 1.1", "roll back 1.1 1.0"));
}

TEST_F(Bundles, WhatWouldNotRunIsNotActivated) {
    const auto key = new_key();
    install("1.0"), install("1.1");
    activate("1.0");
    EXPECT_EQ(activate("9"), "bundle.unknown");
    auto host = small_host();
    host.abi = 7;
    EXPECT_EQ(runtime::activate(store, "cell", "1.1", nobody(), host, joe).error().code, "bundle.abi");
    EXPECT_EQ(runtime::activate(store, "cell", "1.1", trust_in(key), small_host(), joe).error().code, "bundle.unsigned")
        << "trusted since it was installed";
    std::ofstream(store.version_folder("cell", "1.1") / "files/machine/cell.yaml") << "name: other";
    EXPECT_EQ(activate("1.1"), "bundle.sum");
    EXPECT_EQ(active(), "1.0");
}

TEST_F(Bundles, AStartThatFailsThreeTimesEndsInTheVersionBefore) {
    install("1.0"), install("1.1");
    activate("1.0");
    EXPECT_THAT(start(), ElementsAre("1.0"));
    ASSERT_TRUE(start_succeeded(last));
    activate("1.1");
    for (int i = 0; i < 3; ++i) EXPECT_THAT(start(), ElementsAre("1.1")) << i;
    EXPECT_EQ(activations_of(store, "cell").front().failed_starts, 3u);
    EXPECT_THAT(start(), ElementsAre("1.0", "bundle.fell_back"));
    EXPECT_EQ(active(), "1.0");
    EXPECT_THAT(text_of_file(store.folder("cell") / "audit.log"), HasSubstr("3 starts in a row did not reach operation"));
    for (int i = 0; i < 5; ++i)
        EXPECT_THAT(start(), ElementsAre("1.0")) << "it has worked: that it does not start is the machine's trouble";
    EXPECT_EQ(activate("1.1"), "1.0 -> 1.1, back 1.0");
    EXPECT_THAT(start(), ElementsAre("1.1")) << "counted anew";
}

TEST_F(Bundles, AVersionThatHasWorkedIsNotLeft) {
    install("1.0"), install("1.1");
    activate("1.0"), activate("1.1");
    start();
    ASSERT_TRUE(start_succeeded(last));
    for (int i = 0; i < 10; ++i) EXPECT_THAT(start(), ElementsAre("1.1"));
}

TEST_F(Bundles, AVersionThatHasWorkedIsNotLeftEitherWhenItIsTakenOnceMore) {
    install("1.0"), install("1.1");
    activate("1.0");
    start();
    ASSERT_TRUE(start_succeeded(last));
    activate("1.1"), activate("1.0");
    for (int i = 0; i < 10; ++i) EXPECT_THAT(start(), ElementsAre("1.0")) << i;
    activate("1.1");
    for (int i = 0; i < 3; ++i) EXPECT_THAT(start(), ElementsAre("1.1")) << "which never has";
    EXPECT_THAT(start(), ElementsAre("1.0", "bundle.fell_back"));
}

// Somebody starts it by hand while the service brings it up: each of those starts would fail, and in the end the good version be left.
TEST_F(Bundles, AStartOfAMachineThatRunsIsRefusedAndNotCounted) {
    install("1.0"), install("1.1");
    activate("1.0"), activate("1.1");
    {
        const auto running = begin_start(store, "cell", usual_tries, small_host(), joe);
        ASSERT_TRUE(running);
        for (int i = 0; i < 5; ++i) EXPECT_THAT(start(), ElementsAre("bundle.machine_runs"));
        EXPECT_EQ(activations_of(store, "cell").front().failed_starts, 1u);
        EXPECT_EQ(active(), "1.1");
        activate("1.0");
        EXPECT_THAT(start(), ElementsAre("bundle.machine_runs")) << "from another version";
    }
    EXPECT_THAT(start(), ElementsAre("1.0")) << "it has ended";
}

TEST_F(Bundles, AStartThatSomebodyEndedDoesNotCount) {
    install("1.0"), install("1.1");
    activate("1.0"), activate("1.1");
    for (int i = 0; i < 10; ++i) {
        EXPECT_THAT(start(), ElementsAre("1.1"));
        start_was_ended(last);
    }
}

TEST_F(Bundles, WithoutAWayBackItStartsAgainAndSaysSo) {
    install("1.0");
    activate("1.0");
    for (int i = 0; i < 3; ++i) EXPECT_THAT(start(), ElementsAre("1.0"));
    EXPECT_THAT(start(), ElementsAre("1.0", "bundle.no_way_back"));
}

TEST_F(Bundles, WhereNoneHasWorkedTheFirstTriesAreShared) {
    install("1.0"), install("1.1");
    activate("1.0"), activate("1.1");
    EXPECT_THAT(start(1), ElementsAre("1.1"));
    EXPECT_THAT(start(1), ElementsAre("1.0", "bundle.fell_back"));
    EXPECT_THAT(start(1), ElementsAre("1.0", "bundle.no_way_back")) << "never on to the one that failed, and never none";
}

TEST_F(Bundles, ADamagedVersionIsLeftAtOnce) {
    install("1.0"), install("1.1");
    activate("1.0"), activate("1.1");
    std::ofstream(store.version_folder("cell", "1.1") / "files/machine/feeder.so") << "x";
    EXPECT_THAT(start(), ElementsAre("1.0", "bundle.fell_back"));
    std::ofstream(store.version_folder("cell", "1.0") / "files/machine/feeder.so") << "x";
    EXPECT_THAT(start(), ElementsAre("bundle.sum")) << "and where nothing is whole nothing starts";
}

TEST_F(Bundles, WhatIsNotThereIsNamed) {
    EXPECT_THAT(start(), ElementsAre("bundle.unknown"));
    EXPECT_EQ(roll_back(), "bundle.unknown");
    install("1.0");
    EXPECT_THAT(start(), ElementsAre("bundle.none_active"));
    EXPECT_EQ(roll_back(), "bundle.none_active");
    const auto near = store.find("cel", "1.0");
    ASSERT_FALSE(near);
    EXPECT_THAT(near.error().remedy, HasSubstr("did you mean 'cell'?"));
    EXPECT_EQ(begin_start(store, "../cell", 3, small_host(), joe).error().code, "bundle.unknown");
}

TEST_F(Bundles, NeitherTheActiveVersionNorTheWayBackIsRemoved) {
    for (const auto* version : {"1.0", "1.1", "1.2"}) install(version);
    activate("1.0"), activate("1.1"), activate("1.2");
    const auto removed = [&](const std::string& version) {
        const auto done = store.remove("cell", version);
        return done ? std::string("gone") : done.error().code;
    };
    EXPECT_EQ(removed("1.2"), "bundle.in_use");
    EXPECT_EQ(removed("1.1"), "bundle.in_use");
    EXPECT_EQ(removed("1.0"), "gone");
    EXPECT_EQ(removed("1.0"), "bundle.unknown");
    EXPECT_THAT(store.versions("cell"), ElementsAre("1.1", "1.2"));
    EXPECT_EQ(roll_back(), "1.2 -> 1.1, back ") << "the chain ends where a version is gone";
}

TEST_F(Bundles, AVersionThatAMachineRunsFromIsKept) {
    install("1.0"), install("1.1"), install("1.2");
    activate("1.0");
    auto running = begin_start(store, "cell", 3, small_host(), joe);
    ASSERT_TRUE(running);
    activate("1.1"), activate("1.2");
    EXPECT_TRUE(in_use(store.version_folder("cell", "1.0")));
    EXPECT_EQ(store.remove("cell", "1.0").error().code, "bundle.in_use");
    { const auto ended = std::move(running).value(); }
    EXPECT_FALSE(in_use(store.version_folder("cell", "1.0")));
    EXPECT_TRUE(store.remove("cell", "1.0"));
}

TEST_F(Bundles, ManyActivationsLeaveAFew) {
    install("1.0"), install("1.1");
    for (int i = 0; i < 40; ++i) activate(i % 2 == 0 ? "1.0" : "1.1");
    const auto there = fs::directory_iterator(store.folder("cell") / "activations");
    EXPECT_EQ(std::distance(fs::begin(there), fs::end(there)), 10);
    EXPECT_EQ(roll_back(), "1.1 -> 1.0, back 1.1");
}

TEST_F(Bundles, AFolderThatNobodyMayWriteIsSaid) {
    if (::geteuid() == 0) {  // root writes everywhere: a file where the folder should be
        std::ofstream(folder.path() / "root") << "";
        EXPECT_EQ(store.install(file("1.0"), nobody(), small_host()).error().code, "bundle.folder");
        return;
    }
    fs::create_directory(folder.path() / "root");
    fs::permissions(folder.path() / "root", fs::perms::owner_read | fs::perms::owner_exec);
    EXPECT_EQ(store.install(file("1.0"), nobody(), small_host()).error().code, "bundle.folder");
    fs::permissions(folder.path() / "root", fs::perms::owner_all);
}

/// `work` in a process of its own; whether it said yes.
bool in_a_child(const std::function<bool()>& work) {
    const pid_t child = ::fork();
    if (child == 0) ::_exit(work() ? 0 : 1);
    int status = 0;
    return ::waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

/// No file can have a byte: what a full disk is like for whoever writes. Folders and links can be made.
void fill_the_disk() {
    ::signal(SIGXFSZ, SIG_IGN);
    const rlimit none{0, 0};
    ::setrlimit(RLIMIT_FSIZE, &none);
}

TEST_F(Bundles, AFullDiskLeavesNothingOfAnInstall) {
    install("1.0");
    activate("1.0");
    const auto before = everything();
    const auto next = file("1.1");
    EXPECT_TRUE(in_a_child([&] {
        fill_the_disk();
        const auto installed = store.install(next, nobody(), small_host());
        return !installed && installed.error().code == "bundle.not_written";
    }));
    EXPECT_EQ(everything(), before);
}

TEST_F(Bundles, AFullDiskDoesNotHoldUpTheWayBack) {
    install("1.0"), install("1.1");
    activate("1.0"), activate("1.1");
    EXPECT_TRUE(in_a_child([&] {
        fill_the_disk();
        return runtime::activate(store, "cell", "1.0", nobody(), small_host(), joe).error().code == "bundle.not_written";
    })) << "what is not written down is not activated";
    EXPECT_EQ(active(), "1.1");
    EXPECT_TRUE(in_a_child([&] {
        fill_the_disk();
        const auto switched = runtime::roll_back(store, "cell", small_host(), joe);
        return switched && switched->remarks.size() == 1;  // the audit is the poorer by a line, and that is said
    }));
    EXPECT_EQ(active(), "1.0");
    EXPECT_TRUE(in_a_child([&] {
        fill_the_disk();
        const auto begun = begin_start(store, "cell", 3, small_host(), joe);
        return begun && begun->bundle.manifest.version == "1.0" && begun->remarks.size() == 1;
    })) << "and a machine starts";
}

TEST_F(Bundles, RootWorksAsTheOwnerOfTheFolder) {
    if (::geteuid() != 0) GTEST_SKIP() << "only root can become another";
    constexpr uid_t somebody = 65534;
    fs::permissions(folder.path(), fs::perms::all);
    fs::create_directory(folder.path() / "root");
    ASSERT_EQ(::chown((folder.path() / "root").c_str(), somebody, somebody), 0);
    const auto bundle = BundleFile::open(file("1.0"), nobody());
    ASSERT_TRUE(bundle);
    EXPECT_TRUE(in_a_child([&] {
        return act_as_owner(store.root()).ok() && ::geteuid() == somebody && store.install(*bundle, "1.0.twb", small_host()).ok();
    }));
    ASSERT_EQ(store.versions("cell").size(), 1u);
    for (const auto& entry : fs::recursive_directory_iterator(store.bundles())) {
        struct stat info {};
        ASSERT_EQ(::lstat(entry.path().c_str(), &info), 0);
        EXPECT_EQ(info.st_uid, somebody) << entry.path();
    }
}

}  // namespace
}  // namespace taktwerk::runtime
