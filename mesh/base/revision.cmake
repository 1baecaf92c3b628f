# Writes revision.h only when it changed, so that nothing is rebuilt without need.
execute_process(COMMAND git -C ${SOURCE} describe --always --abbrev=10 --dirty=+
                OUTPUT_VARIABLE rev OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(NOT rev)
  set(rev unknown)
endif()
set(text "#define SHB_REVISION \"${VERSION}-${rev}\"\n")
set(old "")
if(EXISTS ${OUT})
  file(READ ${OUT} old)
endif()
if(NOT text STREQUAL old)
  file(WRITE ${OUT} "${text}")
endif()
