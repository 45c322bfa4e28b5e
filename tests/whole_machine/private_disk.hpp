#pragma once
// A small disk in memory for what a machine keeps, seen by this process alone, and what can be wrong with a disk. Where the system lets nobody mount
// anything (possible() is false) it is a plain folder, which can only go away.

#include <filesystem>
#include <random>
#include <string>

namespace taktwerk::whole {

class PrivateDisk {
public:
    PrivateDisk();
    ~PrivateDisk();
    PrivateDisk(const PrivateDisk&) = delete;
    PrivateDisk& operator=(const PrivateDisk&) = delete;

    [[nodiscard]] static bool possible();
    [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }
    void fill();
    void take_nothing();
    /// It cannot be reached at all any more.
    void take_away();
    /// One bit in each of these files, where there are any.
    void flip_a_bit(const std::filesystem::path& file, std::mt19937& random);
    /// All of that is over.
    void mend();

private:
    std::filesystem::path place_, path_;
    bool mounted_ = false, covered_ = false, gone_ = false, full_ = false;
};

}  // namespace taktwerk::whole
