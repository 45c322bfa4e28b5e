// kill -9 while the store writes, at a thousand random instants: whatever stands there is whole, and nothing that a save() had promised is lost.

#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <random>

#include <sys/wait.h>
#include <unistd.h>

#include "core/clock.hpp"
#include "runtime/retain/retain_store.hpp"

namespace taktwerk::runtime {
namespace {

namespace fs = std::filesystem;

constexpr int kills = 1000;
constexpr std::size_t values = 64;  // all the same number: a mixture would be seen

Kept counted(std::uint64_t count) {
    Kept kept;
    for (std::size_t i = 0; i < values; ++i)
        kept.values.push_back({"p.v" + std::to_string(i), RetainKind::retain, fb::PinKind::ULINT, count, 0});
    return kept;
}

/// Goes on counting where the disk says, and tells each count that it was promised is kept. Never returns.
[[noreturn]] void count_for_ever(const fs::path& directory, int told) {
    RetainStore store(directory);
    const auto loaded = store.load();
    auto count = loaded.kept.values.empty() ? 0 : loaded.kept.values.front().bits;
    for (;;) {
        ++count;
        if (!store.save(counted(count)) || ::write(told, &count, sizeof count) != sizeof count) ::_exit(1);
    }
}

TEST(RetainStoreKilled, AtAThousandInstantsNothingIsTornAndNothingPromisedIsLost) {
    auto name = (fs::temp_directory_path() / "taktwerk_killed_XXXXXX").string();
    const fs::path directory = ::mkdtemp(name.data());
    std::mt19937_64 random{2026};
    std::uint64_t promised = 0;
    int with_a_rest = 0;  // a file was being written when it was killed
    SystemClock clock;
    for (int i = 0; i < kills; ++i) {
        int ends[2];
        ASSERT_EQ(::pipe(ends), 0);
        const auto child = ::fork();
        ASSERT_GE(child, 0);
        if (child == 0) {
            ::close(ends[0]);
            count_for_ever(directory, ends[1]);
        }
        ::close(ends[1]);
        // Somewhere in the writing behind one that was promised, however fast this computer is; each fourth, before it has written anything.
        std::uint64_t told = 0;
        if (i % 4 != 0 && ::read(ends[0], &told, sizeof told) == sizeof told) promised = told;
        clock.sleep_until(clock.now() + std::chrono::microseconds{random() % 2000});
        ::kill(child, SIGKILL);
        int status = 0;
        ::waitpid(child, &status, 0);
        EXPECT_TRUE(WIFSIGNALED(status)) << "it ended by itself: a save failed";
        while (::read(ends[0], &told, sizeof told) == sizeof told) promised = told;
        ::close(ends[0]);
        for (const auto* beside : {"retain.0.new", "retain.1.new"}) with_a_rest += fs::exists(directory / beside) ? 1 : 0;

        const auto loaded = RetainStore(directory).load();
        ASSERT_TRUE(loaded.damage.empty()) << "kill " << i << ": " << loaded.damage.front().text();
        if (promised == 0) continue;
        ASSERT_EQ(loaded.kept.values.size(), values);
        for (const auto& value : loaded.kept.values) ASSERT_EQ(value.bits, loaded.kept.values.front().bits) << "kill " << i;
        ASSERT_GE(loaded.kept.values.front().bits, promised) << "kill " << i;
        ASSERT_LE(loaded.kept.values.front().bits, promised + 1) << "kill " << i;
        promised = loaded.kept.values.front().bits;
    }
    EXPECT_GE(promised, static_cast<std::uint64_t>(kills) / 4 * 3) << "each that was waited for has written";
    EXPECT_GT(with_a_rest, 0) << "no kill met a writing";
    fs::remove_all(directory);
}

}  // namespace
}  // namespace taktwerk::runtime
