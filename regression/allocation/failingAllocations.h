// SPDX-License-Identifier: Apache-2.0
//
// The operators new and delete of a program that wants some of its allocations to fail.
#ifndef OPENSUBDIVHEX_REGRESSION_ALLOCATION_FAILING_ALLOCATIONS_H
#define OPENSUBDIVHEX_REGRESSION_ALLOCATION_FAILING_ALLOCATIONS_H

namespace OpenSubdivHex::Regression {

/// Which allocations fail, of those that all threads make while a FailingAllocations lives.
enum class Failing {
    None,    ///< they are counted
    One,     ///< that of the number
    AllSince ///< that of the number, and all after it
};

/// \brief Counts allocations by operator new, and by malloc in the libraries of this project where
/// they are static; the first has number 1.  One at a time.
class FailingAllocations {
public:
    FailingAllocations(Failing failing, long number);
    ~FailingAllocations();

    FailingAllocations(FailingAllocations const &) = delete;
    FailingAllocations &operator=(FailingAllocations const &) = delete;

    long GetCount() const;
    bool HasFailed() const;
};

/// How many allocations of the program were not freed yet.
long CountLiveAllocations();

/// Bytes of the allocations of the program that were not freed yet.
long CountLiveBytes();
/// The most that these were since the last call of ResetPeakBytes().
long GetPeakBytes();
/// Makes the peak what is live now.
void ResetPeakBytes();

} // namespace OpenSubdivHex::Regression

#endif
