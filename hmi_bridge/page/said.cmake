# What failed, and what to do.
message(FATAL_ERROR "The page of the HMI: 'npm ci' could not get its tools (above). It needs a registry of npm packages (npm config get registry) or a full cache; "
  "-DTAKTWERK_PAGE=OFF builds all but the page.")
