"""Problems of a workstation and of a cluster."""
