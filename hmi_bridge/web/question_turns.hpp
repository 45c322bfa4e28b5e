#pragma once
// Whose question goes to the machine next, where all pages share one connection for what they only ask: each has its turn, so that one that asks much
// delays the others by one answer and not by all of its own. A rule without connections. Not thread-safe; not real-time.

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <utility>

namespace taktwerk::hmi::web {

template <class Question>
class QuestionTurns {
public:
    using Asker = std::uint64_t;
    static constexpr std::size_t most_under_way = 4;  ///< as many readings as the machine takes of one connection (scope.busy)
    static constexpr std::size_t most_of_one = 2;

    void put(Asker asker, Question question) { waiting_.push_back({asker, std::move(question)}); }
    /// The next of who has the least under way, among those in order; it is under way then. Nothing: none may go.
    std::optional<std::pair<Asker, Question>> next() {
        if (all_under_way_ >= most_under_way) return std::nullopt;
        auto best = waiting_.end();
        for (auto one = waiting_.begin(); one != waiting_.end(); ++one)
            if (under_way(one->first) < most_of_one && (best == waiting_.end() || under_way(one->first) < under_way(best->first)))
                best = one;
        if (best == waiting_.end()) return std::nullopt;
        auto taken = std::move(*best);
        waiting_.erase(best);
        ++under_way_[taken.first];
        ++all_under_way_;
        return taken;
    }
    void answered(Asker asker) {
        const auto found = under_way_.find(asker);
        if (found == under_way_.end()) return;
        --all_under_way_;
        if (--found->second == 0) under_way_.erase(found);
    }
    /// What waits and fulfils `gone` is taken out and handed over.
    template <class Gone, class Take>
    void remove(Gone gone, Take take) {
        std::deque<std::pair<Asker, Question>> removed;
        for (auto one = waiting_.begin(); one != waiting_.end();) {
            if (!gone(one->first, one->second)) {
                ++one;
                continue;
            }
            removed.push_back(std::move(*one));
            one = waiting_.erase(one);
        }
        for (auto& one : removed) take(one.second);
    }
    [[nodiscard]] std::size_t waiting() const { return waiting_.size(); }

private:
    [[nodiscard]] std::size_t under_way(Asker asker) const {
        const auto found = under_way_.find(asker);
        return found == under_way_.end() ? 0 : found->second;
    }

    std::deque<std::pair<Asker, Question>> waiting_;
    std::map<Asker, std::size_t> under_way_;
    std::size_t all_under_way_ = 0;
};

}  // namespace taktwerk::hmi::web
