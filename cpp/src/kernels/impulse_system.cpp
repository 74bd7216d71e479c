// The system of the active rows of the impulse solver: (A + C) j = residual, see impulse.hpp.
#include "kernels/impulse.hpp"

namespace birm3d {

using Eigen::Index;

// Solves the system of the active rows, with their compliance.
void ImpulseSolver::solve_active() {
    if (!factorised_) factorise();
    for (const std::size_t i : active_)
        rows_[i].residual = rows_[i].shifted_rhs, rows_[i].next = 0.0;
    add_solution(&ConstraintRow::next);
    const int refinements = by_bodies_ ? 3 : 0;
    for (int pass = 0; pass < refinements; ++pass) {
        move_by(&ConstraintRow::next, working_);
        for (const std::size_t i : active_) {
            ConstraintRow& row = rows_[i];
            row.residual = row.shifted_rhs - along(row, working_) - row.compliance * row.next;
        }
        add_solution(&ConstraintRow::next);
    }
}

void ImpulseSolver::factorise() {
    const auto rows = static_cast<Index>(active_.size());
    factorised_ = true;
    by_bodies_ = rows > motion_.size();
    if (!by_bodies_) {
        system_.resize(rows, rows);
        for (Index r = 0; r < rows; ++r) {
            const ConstraintRow& row = rows_[active_[static_cast<std::size_t>(r)]];
            for (Index c = 0; c < r; ++c)
                system_(r, c) = influence(row, rows_[active_[static_cast<std::size_t>(c)]]);
            system_(r, r) = row.diagonal + row.compliance;
        }
    } else {
        system_.setIdentity(motion_.size(), motion_.size());
        for (const std::size_t i : active_) {
            const ConstraintRow& row = rows_[i];
            const auto a = 6 * static_cast<Index>(row.body);
            system_.block<6, 6>(a, a) += row.g / row.compliance * row.g.transpose();
            if (row.other < 0) continue;
            const auto b = Index{6} * row.other;
            system_.block<6, 6>(b, b) += row.g_other / row.compliance * row.g_other.transpose();
            // The factorisation reads the lower triangle only.
            if (a > b)
                system_.block<6, 6>(a, b) += row.g / row.compliance * row.g_other.transpose();
            else
                system_.block<6, 6>(b, a) += row.g_other / row.compliance * row.g.transpose();
        }
    }
    factors_.compute(system_);
}

// Adds the solution of (A + C) j = residual to the active rows' impulses.
void ImpulseSolver::add_solution(double ConstraintRow::* impulses) {
    if (by_bodies_) {
        unknown_.setZero(motion_.size());
        for (const std::size_t i : active_)
            push(rows_[i], rows_[i].residual / rows_[i].compliance, unknown_);
        factors_.solveInPlace(unknown_);
        for (const std::size_t i : active_)
            rows_[i].*impulses += (rows_[i].residual - along(rows_[i], unknown_)) / rows_[i].compliance;
    } else {
        unknown_.resize(static_cast<Index>(active_.size()));
        for (std::size_t k = 0; k < active_.size(); ++k)
            unknown_[static_cast<Index>(k)] = rows_[active_[k]].residual;
        factors_.solveInPlace(unknown_);
        for (std::size_t k = 0; k < active_.size(); ++k)
            rows_[active_[k]].*impulses += unknown_[static_cast<Index>(k)];
    }
}

void ImpulseSolver::move_by(double ConstraintRow::* impulses, Eigen::VectorXd& motion) const {
    motion.setZero(motion_.size());
    for (const std::size_t i : active_)
        push(rows_[i], rows_[i].*impulses, motion);
}

}  // namespace birm3d
