# Files of one target compiled several at a time: what they include is parsed, and inline code made, once for all of
# them. It halves a build from nothing and makes one file's rebuild a little longer: -DPELLUCID_UNITY=OFF compiles each
# file on its own, which also shows that each names all that it uses. Helpers of files that share a target then need
# names of their own.
option(PELLUCID_UNITY "Compile several files at a time" ON)

# pellucid_together(TARGET FILES): TARGET's sources, FILES at a time.
function(pellucid_together target files)
  if(PELLUCID_UNITY)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${files})
  endif()
endfunction()
