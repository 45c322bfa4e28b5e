#pragma once
// Linear least squares of a few unknowns, by the normal equations of scaled columns, with the deviation of each. Not real-time, allocates nothing.

#include <array>
#include <cmath>
#include <cstddef>

#include "axes/measuring/quality.hpp"

namespace taktwerk::axes::measuring {

/// Sums up rows `y = x . c + noise` and solves for c.
template <std::size_t N>
class LeastSquares {
public:
    using Row = std::array<double, N>;

    void add(const Row& x, double y) noexcept {
        ++rows_;
        yy_ += y * y;
        y_ += y;
        for (std::size_t i = 0; i < N; ++i) {
            xy_[i] += x[i] * y;
            for (std::size_t j = 0; j < N; ++j) xx_[i][j] += x[i] * x[j];
        }
    }

    struct Solution {
        std::array<Estimate, N> c;
        double residual = 0;   ///< standard deviation of the noise
        double explained = 0;  ///< part of the variance of y, 0 to 1
        bool solved = false;   ///< false: the columns do not tell the causes apart
    };

    /// A column that is all 0 is left out: its coefficient is not known. `condition`: how small a part of a column may be left that the others do
    /// not explain.
    [[nodiscard]] Solution solve(double condition = 1e-6) const noexcept {
        Solution out;
        std::array<double, N> scale{};
        std::array<bool, N> used{};
        std::size_t count = 0;
        for (std::size_t i = 0; i < N; ++i) {
            used[i] = xx_[i][i] > 0;
            scale[i] = used[i] ? 1 / std::sqrt(xx_[i][i]) : 0;
            count += used[i] ? 1 : 0;
        }
        if (rows_ <= count || count == 0) return out;
        // The inverse of the scaled normal matrix by Gauss-Jordan; its diagonal is 1 before.
        std::array<std::array<double, 2 * N>, N> m{};
        for (std::size_t i = 0; i < N; ++i) {
            for (std::size_t j = 0; j < N; ++j) m[i][j] = used[i] && used[j] ? xx_[i][j] * scale[i] * scale[j] : (i == j ? 1 : 0);
            m[i][N + i] = 1;
        }
        for (std::size_t i = 0; i < N; ++i) {
            if (!(m[i][i] > condition)) return out;
            const double pivot = m[i][i];
            for (auto& value : m[i]) value /= pivot;
            for (std::size_t r = 0; r < N; ++r) {
                if (r == i) continue;
                const double factor = m[r][i];
                for (std::size_t k = 0; k < 2 * N; ++k) m[r][k] -= factor * m[i][k];
            }
        }
        double fitted = 0;
        for (std::size_t i = 0; i < N; ++i) {
            for (std::size_t j = 0; j < N; ++j) out.c[i].value += m[i][N + j] * xy_[j] * scale[j] * scale[i];
            fitted += out.c[i].value * xy_[i];
        }
        const double left = std::fmax(0.0, yy_ - fitted);
        const double variance = left / static_cast<double>(rows_ - count);
        const double spread = yy_ - y_ * y_ / static_cast<double>(rows_);
        out.residual = std::sqrt(variance);
        out.explained = spread > 0 ? std::fmax(0.0, 1 - left / spread) : 0;
        for (std::size_t i = 0; i < N; ++i) {
            out.c[i].deviation = std::sqrt(variance * m[i][N + i]) * scale[i];
            out.c[i].known = used[i];
        }
        out.solved = true;
        return out;
    }
    [[nodiscard]] std::size_t rows() const noexcept { return rows_; }

private:
    std::size_t rows_ = 0;
    double yy_ = 0, y_ = 0;
    std::array<double, N> xy_{};
    std::array<std::array<double, N>, N> xx_{};
};

}  // namespace taktwerk::axes::measuring
