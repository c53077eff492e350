# SPDX-License-Identifier: Apache-2.0
#
# cmake -D nm=... -D library=... -D public=NAME -P exports.cmake
#
# Checks that a shared library exports its public API, of which public is a part of a mangled name,
# and of what is internal no more than the inline code of public headers and other layers call.
set(called AllocateArray FreeArray PrepareArray RangeQueue ForEachRange Report InsertUnique SortUnique
  RefinementRules GetRules FaceRule TruncationMask FindQuadRow
  LimitRows CheckLimitLevel LimitOrigins LatticePatch LatticeFaces PlainFaces
  RegularFaces MakeFaceParameterization FindInPlane FindFaceCoords FindCellPatchPoints
  GetStepsToLimit GatherBaseCell FindBaseCellTurns GatherBorder RefineCell
  UseNextMasks ComesApart GatherFanItems FindCornerLimits PatchRefinement GetVertexMarks StepRowBack FinishPlainBaseCell IndexMap MakeQuadFlag QuadCorners
  Device MakeDeviceLimit MakeDeviceRefinements
  CheckChannel CheckStencilMode GetChannelInterpolation GetModeInterpolation
  CheckLevel CheckDescriptors)

execute_process(COMMAND ${nm} --dynamic --defined-only --format=posix ${library}
  OUTPUT_VARIABLE symbols COMMAND_ERROR_IS_FATAL ANY)
if(NOT symbols MATCHES "${public}")
  message(SEND_ERROR "${library} does not export ${public}")
endif()
string(REGEX MATCHALL "_Z[A-Z]*N[A-Z]*13OpenSubdivHex6[A-Za-z]*8internal[^ \n]*" internals
  "${symbols}")
list(JOIN called "|" calledRegex)
foreach(symbol IN LISTS internals)
  if(NOT symbol MATCHES "8internal[0-9]+(${calledRegex})[^a-z]")
    message(SEND_ERROR "${library} exports the internal ${symbol}")
  endif()
endforeach()
