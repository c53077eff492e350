// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TOOLS_OUTPUT_FILE_H
#define OPENSUBDIVHEX_TOOLS_OUTPUT_FILE_H

#include <cstdio>
#include <string>
#include <string_view>

namespace OpenSubdivHex::Tools {

/// \brief A file that appears whole or not at all.
///
/// Content goes to a temporary file that Commit() puts in the place of the target; without Commit()
/// it is removed and the target stays as it was.  On Linux it has no name before Commit(), so that
/// nothing is left of a process that is killed while it writes; elsewhere, and on disks that know
/// no such files, it lies beside the target.  What a process that was killed leaves there is
/// removed by the next one that writes the same target.
///
/// A target that is a link stays one: the file that it leads to is written, there or not.  A file
/// that is replaced hands on its mode and, where the user may give files away, its owner; one that
/// the user may not write is refused.  Other hard links to it keep the old content.  A target that
/// is no regular file, such as /dev/null, is written directly.  All functions throw FileError.
class OutputFile {
public:
    explicit OutputFile(std::string const &path);
    ~OutputFile();

    OutputFile(OutputFile const &) = delete;
    OutputFile &operator=(OutputFile const &) = delete;

    /// Writes at once: contents should be large.
    void Write(std::string_view content);

    void Commit();

private:
    bool openNamed(std::string const &path);
    void nameUnnamed();
    [[noreturn]] void refuse() const;

    std::string _path;          ///< as given, for messages
    std::string _targetPath;    ///< links resolved
    std::string _temporaryPath; ///< of a temporary file while it has a name
    bool _isSpecial = false;    ///< whether the target is written directly
    bool _isUnnamed = false;    ///< a temporary file that gets its name from Commit
    std::FILE *_file = nullptr;
    int _handle = -1; ///< of the file when it is closed: it keeps the lock, and can give the name
};

/// \brief Opens a file for what is written and read again before \p path is written: it has no name, lies
/// on the same disk where that knows such files, and is gone when it is closed.  Throws FileError.
std::FILE *OpenScratchFile(std::string const &path);

/// \brief Whether what is written to one path replaces what is written to the other, however they
/// are spelled and whatever links they have; the files need not be there.  False for devices.
bool IsSameOutput(std::string const &path, std::string const &otherPath);

} // namespace OpenSubdivHex::Tools

#endif
