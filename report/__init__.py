"""What people read: the files beside an artefact, in drawing units, and the sections of the report."""
